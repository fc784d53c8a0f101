/** Tests of a train that were dropped on the page: they stay while tabs and trains change. */

export interface Tests {
  name: string;
  text: string;
}

class Measured {
  tests = $state.raw<Tests | null>(null);
  /** What of the heat is shown. */
  part = $state<"temperatures" | "tests">("temperatures");

  /** Takes the first table of some files; whether there was one. */
  async take(files: FileList | File[]): Promise<boolean> {
    const table = [...files].find((f) => /\.csv$/i.test(f.name));
    if (!table) return false;
    this.tests = { name: table.name, text: await table.text() };
    this.part = "tests";
    return true;
  }
}

export const measured = new Measured();
