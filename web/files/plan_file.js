// A request and its answer as one document: what is saved, opened again, and what /v1/validate takes. Pure.

/** The document: the members of the answer (or null) beside those of the request. */
export function planFile(request, answer) {
  return { ...request, plans: [], ...answer };
}
