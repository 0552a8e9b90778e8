// The other end of the page's messages: a program behind a socket, or one in a worker of this tab.

export interface Hears {
  opened(): void;
  data(data: string | ArrayBuffer): void;
  closed(code: number, why: string): void; // a code of RFC 6455, and why in words, or empty
}

export interface End {
  readonly token: string; // that it requires; empty: unknown
  readonly here: boolean; // in this tab: it is silent while it prepares, and does not come back by itself

  /** Opens it, or again. */
  open(hears: Hears): void;
  /** False where there is no connection to send it over. */
  send(text: string): boolean;
  /** Gives it a file to touch; resolves to what is wrong with it, in words. */
  give(file: File): Promise<string | undefined>;
  /** What a page that frames this one gives: `take` gets each file, one from before this call, too. Absent where nobody may. */
  takeGiven?(take: (file: File) => void): void;
  /** Nothing is received from it from here on. */
  close(): void;
}

export const kAbnormal = 1006;
export const kPolicyViolation = 1008;
export const kServiceRestart = 1012;
