// Texts that are too large for an address, kept in this browser (IndexedDB) under ids. One database has requests {name,
// text}. Another has plans {request, answer}, both as texts.

const BY_TIME = "at";
const MAX = 10; // of each; the oldest ones are dropped

export const keptRequests = () => new Kept("fleetplan", "requests");
export const keptPlans = () => new Kept("fleetplan-plans", "plans");

/** An id that no other page uses. */
export const freshId = () => `${Date.now().toString(36)}-${Math.random().toString(36).slice(2)}`;

class Kept {
  #database;
  #name;
  /** @type {Promise<IDBDatabase> | null} */
  #opening = null;

  constructor(database, name) {
    this.#database = database;
    this.#name = name;
  }

  /** Keeps an object under an id, in place of an earlier one. Rejects if the browser does not allow it. */
  async put(id, value) {
    const store = await this.#store("readwrite");
    await done(store.put({ ...value, id, at: Date.now() }));
    const ids = await done(store.index(BY_TIME).getAllKeys());
    await Promise.all(ids.slice(0, -MAX).map((old) => done(store.delete(old))));
    await completed(store.transaction); // the browser drops all of it if the page ends before
  }

  /** What is kept under an id, or null. */
  async get(id) {
    const store = await this.#store("readonly");
    return (await done(store.get(id))) ?? null;
  }

  async #store(mode) {
    this.#opening ??= open(this.#database, this.#name);
    const database = await this.#opening;
    return database.transaction(this.#name, mode).objectStore(this.#name);
  }
}

function open(database, name) {
  const opening = indexedDB.open(database, 1);
  opening.onupgradeneeded = () => {
    opening.result.createObjectStore(name, { keyPath: "id" }).createIndex(BY_TIME, BY_TIME);
  };
  return done(opening);
}

/** Resolves to the result of a request to the database. */
function done(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

/** Resolves when what a transaction has written is kept. */
function completed(transaction) {
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve(undefined);
    transaction.onabort = () => reject(transaction.error);
  });
}
