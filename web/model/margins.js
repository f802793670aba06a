// Margins that hold, see POST /v1/margins: the request for a form of a simulation, and what was found. Pure.

import { disturbanceOf } from "./simulation.js";

/**
 * The body of the request. `form`: see FIRST_FORM of simulations. `accepted`: the share of executions that may have a
 * collision or a deadlock.
 */
export function marginsOf(request, form, accepted) {
  const { policy, seed, maxDelay } = form;
  return {
    request,
    policy,
    seed,
    disturbance: disturbanceOf(form),
    aim: { collisions: accepted },
    ...(policy === "clock_stop" ? { max_delay: maxDelay } : {}),
  };
}

/**
 * The candidates of an answer that were executed: [{options, runs, share, cost, isBest}]. `share` of their executions
 * had a collision or a deadlock; `cost` is the increase of the flowtime over the base, as a share.
 */
export function candidatesOf({ tried, best }) {
  const base = tried[0].planned?.flowtime ?? 0;
  return tried
    .map(({ options, planned, runs, share }, at) => ({
      options,
      runs,
      share,
      cost: planned && base > 0 ? planned.flowtime / base - 1 : 0,
      isBest: at === best,
    }))
    .filter(({ runs }) => runs > 0);
}

/** The request with the margins that were found. */
export const withMargins = (request, { options }) => ({
  ...request,
  options: { ...request.options, ...options },
});
