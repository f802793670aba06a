// A service with its document and a client, for the length of one test file.

import { after } from "node:test";

import { startService } from "../../web/support/service.js";
import { Client } from "./client.js";
import { Document, fetchDocument } from "./document.js";

/** Starts a service with these flags: {document, client, service}. It is stopped after the file's tests. */
export async function openSession(flags = []) {
  const service = await startService(flags);
  const document = new Document(await fetchDocument(service.url));
  const client = new Client(service.url, document);
  after(async () => {
    client.close();
    await service.stop();
  });
  return { service, document, client };
}
