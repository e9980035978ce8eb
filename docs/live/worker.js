// SPDX-License-Identifier: MIT
// Draws, beside the page's own thread. Each message is answered by one with the same id.

const modules = {};
const scenes = {};
const drawn = {};  // for each side of a comparison, its lesson and what it was made for
const viewNames = ["--yaw", "--pitch", "--distance", "--fov", "--depth"];  // nothing is made anew for them

/** @param {string} text  Base64 of gzip, as the page's scripts have it. */
async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const tasks = {
  lesson: async ({ name, text, bytes }) => {
    modules[name] = await WebAssembly.compile(bytes ?? (await unpacked(text)));
    const { model, hasProbe, methods, controls } = new Lesson(modules[name]);
    return { model, hasProbe, methods, controls };
  },

  scene: async ({ name, text }) => {
    scenes[name] = await unpacked(text);
    return {};
  },

  draw: ({ side, name, model, settings, size }) => {
    const isView = ([option]) => viewNames.includes(option);
    const made = JSON.stringify([name, model, Object.entries(settings).filter((entry) => !isView(entry))]);
    const start = performance.now();
    try {
      if (drawn[side]?.made !== made) {
        delete drawn[side];
        const lesson = new Lesson(modules[name]);
        lesson.set(settings);
        lesson.take(scenes[model]);
        drawn[side] = { made, lesson };
      }
      const { lesson } = drawn[side];
      const view = lesson.controls.filter((control) => viewNames.includes(control.name));
      lesson.set(Object.fromEntries(view.map(({ name, preset }) => [name, settings[name] ?? preset])));
      const prepared = performance.now();
      const pixels = lesson.draw(...size);
      return { pixels, printed: lesson.printed, prepareMs: prepared - start, ms: performance.now() - prepared };
    } catch (error) {
      delete drawn[side];  // who knows in what state it is
      throw error;
    }
  },

  probe: ({ side, pixel }) => ({ text: drawn[side].lesson.probe(...pixel) }),
};

function inWords(error) {
  if (error instanceof LessonError) return error.message;
  if (error instanceof WebAssembly.CompileError)
    return "This browser does not know all instructions of this program: lesson 14 needs SIMD of 128 bits.";
  const name = functionOf(error);
  if (name?.endsWith("abort") && !error.said) return "The program gave up, most likely since there was not enough memory.";
  const where = name ? ` in ${name}` : "";
  if (/call stack|too much recursion/.test(error.message)) return `The program calls itself without end${where}.`;
  if (error instanceof RangeError || /bad_alloc|length_error/.test(error.said ?? ""))
    return "There is not enough memory for this picture. Fewer samples or a smaller depth map take less.";
  return `The program ended${where}: ${error.said?.trim() || error.message}.`;
}

onmessage = async ({ data }) => {
  try {
    const answer = await tasks[data.task](data);
    postMessage({ id: data.id, ...answer }, answer.pixels ? [answer.pixels.buffer] : []);
  } catch (error) {
    postMessage({ id: data.id, error: inWords(error) });
  }
};
