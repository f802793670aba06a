// What a request lists, valid or not: no list counts as an empty one. Pure.

const listIn = (request, member) => (Array.isArray(request?.[member]) ? request[member] : []);

/** The robots of the request. */
export const robotsOf = (request) => listIn(request, "robots");

/** The moving obstacles of the request. */
export const obstaclesOf = (request) => listIn(request, "obstacles");

/** The zones of the request. */
export const zonesOf = (request) => listIn(request, "zones");
