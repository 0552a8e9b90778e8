// What a tab's worker and its page say to each other, beside the protocol's own texts and bytes.

import type { Wanted } from "./wanted";

export type ToWorker =
  | string // a message of the protocol
  | { kind: "open"; wanted: Wanted; request: number }
  | { kind: "connect" }; // a page is there, anew

export type FromWorker =
  | string
  | ArrayBuffer
  | { kind: "ready" } // there is something to touch
  | { kind: "another"; request: number } // something else than before; 0: the program asked for it
  | { kind: "refused"; request: number; words: string } // it could not be opened; what was there goes on
  | { kind: "closed"; code: number; why: string }
  | { kind: "died"; why: string };
