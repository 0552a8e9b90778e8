// Gives the program a file to touch: dropped on the page, chosen, or given by a page that holds this one.

import type { End } from "../protocol/end";
import { byId } from "./dom";
import type { Notices } from "./notices";

export class Opening {
  private most = 0; // bytes that the program takes; 0: it takes no file
  private inside = 0; // elements of the page that a dragged file is in

  constructor(private readonly end: End, private readonly notices: Notices) {
    const field = byId<HTMLInputElement>("open-file");
    byId("open").addEventListener("click", () => field.click());
    field.addEventListener("change", () => {
      this.takeFirst(field.files);
      field.value = ""; // the same one may be chosen again
    });
    this.watchDragging();
  }

  /** `most`: bytes that a file may have; undefined: this run takes none. */
  begin(most: number | undefined): void {
    this.most = most ?? 0;
    byId("open").hidden = this.most === 0;
    if (this.most > 0) this.end.takeGiven?.((file) => this.take(file)); // what came before this run, too
  }

  private watchDragging(): void {
    const on = (type: "dragenter" | "dragover" | "dragleave" | "drop", act: (event: DragEvent) => void) =>
      document.addEventListener(type, (event) => {
        if (!event.dataTransfer?.types.includes("Files")) return;
        event.preventDefault(); // else the browser leaves this page for the file
        act(event);
      });
    on("dragenter", () => this.show(this.inside + 1));
    on("dragover", () => undefined);
    on("dragleave", () => this.show(this.inside - 1));
    on("drop", (event) => {
      this.show(0);
      this.takeFirst(event.dataTransfer?.files ?? null);
    });
  }

  private show(inside: number): void {
    this.inside = Math.max(0, inside);
    byId("drop").hidden = this.inside === 0 || this.most === 0;
  }

  private takeFirst(files: FileList | null): void {
    const file = files?.[0];
    if (file === undefined) return;
    if (files!.length > 1) this.notices.add("info", `of ${files!.length} files only ${file.name} is opened`);
    this.take(file);
  }

  private take(file: File): void {
    if (this.most === 0) {
      this.notices.add("warning", "this run opens no other file: it has a device, writes files or shows a recording");
    } else if (file.size > this.most) {
      this.notices.add("warning", `${file.name} is too large for the page; give it to the program on its command line`);
    } else {
      void this.send(file);
    }
  }

  private async send(file: File): Promise<void> {
    const words = `${this.end.here ? "preparing" : "sending"} ${file.name}`;
    this.notices.add("info", words, this.end.here ? 0 : undefined); // a program elsewhere says how far it is
    const wrong = await this.end.give(file);
    if (wrong !== undefined) this.notices.add("warning", wrong);
    this.notices.takeBack(words);
  }
}
