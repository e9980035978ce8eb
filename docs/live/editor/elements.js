// SPDX-License-Identifier: MIT

/** An element with its properties and children; a property with a hyphen is an attribute. */
export function element(tag, values = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(values))
    if (name.includes("-") || name === "role") made.setAttribute(name, value);
    else made[name] = value;
  made.append(...children);
  return made;
}

export const button = (text, onclick, values = {}) => element("button", { type: "button", textContent: text, onclick, ...values });

export function download(bytes, name, type) {
  const url = URL.createObjectURL(new Blob([bytes], { type }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
