// What a tab's worker and its page say to each other, beside the protocol's own texts and bytes.

import type { Wanted } from "./wanted";

export type ToWorker =
  | string // a message of the protocol
  | { kind: "open"; wanted: Wanted }
  | { kind: "connect" }; // a page is there, anew

export type FromWorker =
  | string
  | ArrayBuffer
  | { kind: "ready" } // there is something to touch
  | { kind: "another" } // something else than before
  | { kind: "refused"; words: string } // it could not be opened; what was there goes on
  | { kind: "closed"; code: number; why: string }
  | { kind: "died"; why: string };
