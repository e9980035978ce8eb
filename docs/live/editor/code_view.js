// SPDX-License-Identifier: MIT
// Files to write in, one of them shown: CodeMirror.

import { indentWithTab } from "@codemirror/commands";
import { cpp } from "@codemirror/lang-cpp";
import { HighlightStyle, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { unifiedMergeView } from "@codemirror/merge";
import { EditorState, Prec } from "@codemirror/state";
import { EditorView, keymap } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { basicSetup } from "codemirror";

/** The site's own colours of code, light and dark. */
const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--fragment-comment)" },
  { tag: [tags.string, tags.character, tags.number, tags.bool, tags.null], color: "var(--fragment-token)" },
  { tag: [tags.keyword, tags.modifier, tags.definitionKeyword, tags.operatorKeyword], color: "var(--fragment-keyword)" },
  { tag: [tags.typeName, tags.standard(tags.typeName), tags.namespace], color: "var(--fragment-keywordtype)" },
  { tag: tags.controlKeyword, color: "var(--fragment-keywordflow)" },
  { tag: [tags.processingInstruction, tags.meta, tags.moduleKeyword], color: "var(--fragment-preprocessor)" },
]);
const look = EditorView.theme({
  "&": { height: "100%", backgroundColor: "var(--fragment-background)", color: "var(--fragment-foreground)", },
  ".cm-content": { caretColor: "var(--page-foreground-color)" },
  ".cm-cursor": { borderLeftColor: "var(--page-foreground-color)" },
  ".cm-gutters": { backgroundColor: "var(--fragment-linenumber-background)", color: "var(--fragment-linenumber-color)", borderRight: "1px solid var(--separator-color)" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--primary-color) 9%, transparent)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { background: "color-mix(in srgb, var(--primary-color) 28%, transparent) !important" },
  ".cm-matchingBracket, &.cm-focused .cm-matchingBracket": { backgroundColor: "color-mix(in srgb, var(--primary-color) 22%, transparent)" },
  ".cm-selectionMatch": { backgroundColor: "color-mix(in srgb, var(--primary-color) 16%, transparent)" },
  ".cm-panels, .cm-tooltip": { backgroundColor: "var(--page-background-color)", color: "var(--page-foreground-color)", borderColor: "var(--separator-color)" },
  ".cm-textfield": { backgroundColor: "var(--fragment-background)", color: "inherit" },
  ".cm-button": { backgroundImage: "none", backgroundColor: "var(--code-background)", color: "inherit" },
  ".cm-foldPlaceholder, .cm-collapsedLines": { background: "var(--code-background)", color: "var(--page-secondary-foreground-color)" },
  ".cm-changedLine": { backgroundColor: "var(--added) !important" },
  ".cm-deletedChunk": { backgroundColor: "var(--removed) !important", paddingLeft: "6px" },
  ".cm-deletedText": { background: "none !important", textDecoration: "none" },
  ".cm-collapsedLines::before, .cm-collapsedLines::after": { content: "'\\22ef' !important" },
});
const plain = [basicSetup, cpp(), Prec.high(syntaxHighlighting(colours)), look, indentUnit.of("    "), EditorState.tabSize.of(4)];
const severities = { error: "error", warning: "warning", note: "info" };

/** As CodeMirror marks it: the word at which the compiler points. */
function diagnosticOf({ line, column, severity, text }, doc) {
  const { from, to, text: code } = doc.line(Math.min(Math.max(line, 1), doc.lines));
  const start = Math.min(from + Math.max(column - 1, 0), to);
  const word = code.slice(start - from).match(/^\w+/)?.[0].length ?? 1;
  return { from: start, to: Math.min(start + word, to), severity: severities[severity] ?? "error", message: text };
}

export class CodeView {
  /** @param {object} calls  changed(file, text) after each edit; run() for Ctrl+Enter. */
  constructor(parent, calls) {
    this.calls = calls;
    this.states = {};
    this.scrolled = {};  // how far, by file
    this.shown = "";
    this.view = new EditorView({ parent });
  }

  /** Takes the place of all files. */
  open(files) {
    this.shown = "";
    this.states = {};
    for (const [name, text] of Object.entries(files)) this.states[name] = this.stateOf(name, text);
  }

  stateOf(name, text) {
    const run = () => this.calls.run() ?? true;
    return EditorState.create({
      doc: text,
      extensions: [
        Prec.highest(keymap.of([{ key: "Ctrl-Enter", run }, { key: "Mod-Enter", run }])),
        plain,
        keymap.of([indentWithTab]),
        lintGutter(),
        EditorView.contentAttributes.of({ "aria-label": `${name}: write here`, "aria-describedby": "editor-keys" }),
        EditorView.updateListener.of((update) => update.docChanged && this.calls.changed(name, update.state.doc.toString())),
      ],
    });
  }

  put(name, text) {
    this.states[name] = this.stateOf(name, text);
    if (this.shown === name) this.view.setState(this.states[name]);
  }

  remove(name) {
    delete this.states[name];
    if (this.shown === name) this.shown = "";
  }

  show(name) {
    this.leave();
    this.shown = name;
    this.view.setState(this.states[name]);
    if (this.scrolled[name]) this.view.dispatch({ effects: this.scrolled[name] });
  }

  /** What was edited last is to be found again. */
  leave() {
    if (!this.shown) return;
    this.states[this.shown] = this.view.state;
    this.scrolled[this.shown] = this.view.scrollSnapshot();
  }

  /** What changes from one text of a file to another. */
  showDifference(name, original, changed) {
    this.leave();
    this.shown = "";
    this.view.setState(EditorState.create({
      doc: changed,
      extensions: [
        plain,
        EditorState.readOnly.of(true),
        EditorView.contentAttributes.of({ "aria-label": `${name}: what differs from the course's` }),
        unifiedMergeView({ original, mergeControls: false, highlightChanges: false, collapseUnchanged: { margin: 3, minSize: 6 } }),
      ],
    }));
  }

  /** Marks, in each file, the lines of which the compiler says something. */
  mark(messages) {
    this.leave();
    for (const [name, state] of Object.entries(this.states)) {
      const found = setDiagnostics(state, messages.filter(({ file }) => file === name).map((message) => diagnosticOf(message, state.doc)));
      if (name === this.shown) this.view.dispatch(found);
      else this.states[name] = state.update(found).state;
    }
  }

  /** Puts the cursor where a message points. */
  goTo(line, column) {
    const { doc } = this.view.state;
    const { from, to } = doc.line(Math.min(Math.max(line, 1), doc.lines));
    const at = Math.min(from + Math.max(column - 1, 0), to);
    this.view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
    this.view.focus();
  }

  focus() {
    this.view.focus();
  }
}
