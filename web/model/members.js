// Objects that are never changed in place. Pure.

/** The value if it is an object with members, else an empty one. */
export function objectOf(value) {
  return value !== null && typeof value === "object" && !Array.isArray(value) ? value : {};
}

/** The object with a member set, or left out if undefined; the same object if that changes nothing. */
export function withMember(object, name, value) {
  if (Object.is(object[name], value)) return object;
  const changed = { ...object, [name]: value };
  if (value === undefined) delete changed[name];
  return changed;
}

/** The object with several members set or left out. */
export function withMembers(object, members) {
  return Object.entries(members).reduce((changed, [name, value]) => withMember(changed, name, value), object);
}
