// A program behind a socket.

import type { End, Hears } from "./end";

const kLongest = 60; // characters of a name
const kAgain = 1500; // ms: a run that ends cuts off what it has not answered, and another may follow

/** What the program takes as the name of a file, as like `name` as can be; its ending stays. */
export function fileName(name: string): string {
  // eslint-disable-next-line no-control-regex
  const plain = [...name.replace(/[/\u0000-\u001f\u007f]+/g, "_")].slice(-kLongest).join("");
  return plain.replace(/^\.+/, "_") || "_";
}

export class SocketEnd implements End {
  readonly here = false;
  private socket: WebSocket | undefined;

  constructor(private readonly address: string, readonly token: string) {}

  open(hears: Hears): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => hears.opened();
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => hears.data(event.data);
    socket.onclose = (event) => {
      if (this.socket === socket) hears.closed(event.code, event.reason);
    };
  }

  send(text: string): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(text);
    return true;
  }

  async give(file: File): Promise<string | undefined> {
    const put = () => fetch(`open/${encodeURIComponent(fileName(file.name))}`,
      { method: "PUT", body: file, headers: { Authorization: `Bearer ${this.token}` } });
    const later = () => new Promise((resolve) => setTimeout(resolve, kAgain));
    try {
      const answer = await put().catch(() => later().then(put));
      return answer.ok ? undefined : `${file.name}: ${await answer.text()}`;
    } catch {
      return `${file.name} could not be sent: the program does not answer, or the file cannot be read`;
    }
  }

  close(): void {
    const socket = this.socket;
    this.socket = undefined; // from here on nobody listens to it
    if (socket === undefined) return;
    socket.onopen = null;
    socket.onmessage = null;
    socket.close();
  }
}
