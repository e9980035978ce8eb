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

// A short piece of code stays on one line: "--stats" is not to end a line after its hyphens.
for (const code of document.querySelectorAll(".textblock code"))
  if (code.textContent.length < 30) code.style.whiteSpace = "nowrap";
