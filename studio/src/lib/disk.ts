/** The file on disk, where `willis studio` serves the page: both follow each other. */

import type { Doc } from "./types";

/** What the server puts into the page. */
export interface Served extends Doc {
  etag: string;
}

export class Disk {
  #tag: string;
  #text: string;
  #writing: Promise<void> = Promise.resolve();

  /** `changed` hears of another text on disk, `told` of what went wrong. */
  constructor(
    served: Served,
    private readonly changed: (doc: Doc) => void,
    private readonly told: (what: string) => void,
  ) {
    this.#tag = served.etag;
    this.#text = served.text;
    void this.#follow();
  }

  /** Writes a text, over what the page has seen and nothing else. */
  write(text: string): void {
    this.#writing = this.#writing.then(async () => {
      if (text === this.#text) return;
      const reply = await fetch("file", { method: "PUT", headers: { "If-Match": this.#tag }, body: text }).catch(() => null);
      if (reply?.ok) {
        this.#text = text;
        this.#tag = reply.headers.get("ETag") ?? this.#tag;
      } else if (reply?.status === 412) this.told("The file was changed elsewhere; it is read again, and your change can be redone.");
      else this.told("The file could not be written: the program that serves this page does not answer.");
    });
  }

  async #follow(): Promise<void> {
    for (;;) {
      const reply = await fetch(`changes?since=${encodeURIComponent(this.#tag)}`).catch(() => null);
      if (!reply) {
        this.told("The program that serves this page has ended.");
        return;
      }
      await this.#writing;
      // An editor that replaces the file takes it away for a moment.
      if (reply.status === 404) await new Promise((done) => setTimeout(done, 1000));
      if (reply.status !== 200) continue;
      const now = (await reply.json()) as Served;
      if (now.etag === this.#tag) continue;
      this.#tag = now.etag;
      if (now.text === this.#text) continue;
      this.#text = now.text;
      this.changed(now);
    }
  }
}
