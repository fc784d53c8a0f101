import { mount } from "svelte";
import App from "./App.svelte";
import "./app.css";

// A browser may pan although a mark inside a picture says `touch-action: none`, and then takes the pointer of a drag away: the move of a
// finger that began on such a mark pans nothing.
let drags = false;
document.addEventListener(
  "touchstart",
  (e) => (drags = e.target instanceof SVGElement && getComputedStyle(e.target).touchAction === "none"),
  { capture: true, passive: true },
);
document.addEventListener("touchmove", (e) => drags && e.cancelable && e.preventDefault(), { capture: true, passive: false });

mount(App, { target: document.getElementById("app")! });
