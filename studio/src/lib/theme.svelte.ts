/** Whether the page is dark: its own choice, else the reader's screen. Figures of the library are asked for in that theme. */

class Theme {
  dark = $state(false);

  constructor() {
    const screen = matchMedia("(prefers-color-scheme: dark)");
    const read = () => {
      const chosen = document.documentElement.dataset.theme;
      this.dark = chosen === "dark" || (chosen !== "light" && screen.matches);
    };
    screen.addEventListener("change", read);
    new MutationObserver(read).observe(document.documentElement, { attributeFilter: ["data-theme"] });
    read();
  }

  get name(): "dark" | "light" {
    return this.dark ? "dark" : "light";
  }
}

export const theme = new Theme();
