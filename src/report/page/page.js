"use strict";
// Sliders: without this script, and in print, their two pictures stand side by side.
document.documentElement.classList.add("moves");
for (const slider of document.querySelectorAll(".slider")) {
  const pictures = slider.querySelector(".pictures");
  const input = slider.querySelector("input");
  const show = () => pictures.style.setProperty("--border", input.value + "%");
  const follow = (event) => {
    const box = pictures.getBoundingClientRect();
    input.value = (100 * (event.clientX - box.left)) / box.width;
    show();
  };
  input.addEventListener("input", show);
  pictures.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    pictures.setPointerCapture(event.pointerId);
    input.focus();
    follow(event);
  });
  pictures.addEventListener("pointermove", (event) => {
    if (pictures.hasPointerCapture(event.pointerId)) follow(event);
  });
  show();
}
