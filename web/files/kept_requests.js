// Requests that are too large for an address, kept in this browser (IndexedDB) under ids.

const DATABASE = "fleetplan";
const STORE = "requests";
const BY_TIME = "at";
const MOST = 10; // requests; the oldest ones are dropped

export class KeptRequests {
  /** @type {Promise<IDBDatabase> | null} */
  #opening = null;

  /** Keeps a request {name, text} under an id, in place of an earlier one. Rejects if the browser does not allow it. */
  async put(id, { name, text }) {
    const store = await this.#store("readwrite");
    await done(store.put({ id, name, text, at: Date.now() }));
    const ids = await done(store.index(BY_TIME).getAllKeys());
    await Promise.all(ids.slice(0, -MOST).map((old) => done(store.delete(old))));
  }

  /** The request {name, text} that is kept under an id, or null. */
  async get(id) {
    const store = await this.#store("readonly");
    return (await done(store.get(id))) ?? null;
  }

  async #store(mode) {
    this.#opening ??= open();
    const database = await this.#opening;
    return database.transaction(STORE, mode).objectStore(STORE);
  }
}

function open() {
  const opening = indexedDB.open(DATABASE, 1);
  opening.onupgradeneeded = () => {
    opening.result.createObjectStore(STORE, { keyPath: "id" }).createIndex(BY_TIME, BY_TIME);
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
