// SPDX-License-Identifier: MIT
DoxygenAwesomeDarkModeToggle.init();
DoxygenAwesomeFragmentCopyButton.init();
DoxygenAwesomeParagraphLink.init();

renderMathInElement(document.querySelector(".contents"), {
  delimiters: [
    { left: "\\(", right: "\\)", display: false },
    { left: "\\[", right: "\\]", display: true },
  ],
});

// A mark behind a formula, or a bracket before it, goes with it: no line begins with a full stop.
for (const formula of document.querySelectorAll(".contents :not(.katex-display) > .katex")) {
  const pieces = formula.querySelectorAll(".katex-html > .base");
  const take = (text, marks, put) => {
    const found = text?.nodeType === Node.TEXT_NODE && text.data.match(marks);
    if (!found || pieces.length === 0) return;
    text.data = text.data.replace(marks, "");
    const mark = document.createElement("span");
    mark.className = "mark";
    mark.textContent = found[0];
    put(mark);
  };
  take(formula.parentElement.nextSibling, /^[.,:;!?)]+/, (mark) => pieces[pieces.length - 1].append(mark));
  take(formula.parentElement.previousSibling, /\($/, (mark) => pieces[0].prepend(mark));
}

// A card of the gallery turns under the pointer, with the keyboard's focus, and after a tap.
if (!matchMedia("(prefers-reduced-motion: reduce)").matches)
  for (const card of document.querySelectorAll(".gallery li")) {
    const picture = card.querySelector("img");
    const still = picture.src;
    const show = (events, source) => {
      for (const event of events) card.addEventListener(event, () => (picture.src = source));
    };
    show(["mouseenter", "focusin", "click"], picture.dataset.turn);
    show(["mouseleave", "focusout"], still);
  }

// A short piece of code stays on one line: "--stats" is not to end a line after its hyphens.
for (const code of document.querySelectorAll(".textblock code"))
  if (code.textContent.length < 30) code.style.whiteSpace = "nowrap";

// For screen readers and keyboards: what Doxygen leaves without a name or out of reach.
const nameSearch = () => {
  for (const field of document.querySelectorAll("#MSearchField")) field.setAttribute("aria-label", "Search");
};
// Doxygen makes the field late, and anew when the window's width changes.
new MutationObserver(nameSearch).observe(document.getElementById("top"), { childList: true, subtree: true });
nameSearch();
document.getElementById("doc-content")?.setAttribute("role", "main");
for (const box of document.querySelectorAll(".fragment, pre.diff, table, .formulaDsp, .katex-display"))
  if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
