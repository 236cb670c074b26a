// The keyboard must reach what scrolls: formulas that are wider than the page.
addEventListener("load", () => {
  for (const { parentElement: box } of document.querySelectorAll("math")) if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
});
