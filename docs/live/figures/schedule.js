// SPDX-License-Identifier: MIT
figure("schedule", (code) => {
  // As in C++: the split, and a tile's side, which rows do not need.
  const splits = { rows: [0, 64], interleaved: [1, 64], 256: [2, 256], 128: [2, 128], 64: [2, 64], 32: [2, 32] };
  let workers = 8, split = "128", at = 0.6;  // at: the moment shown, as a share of the longest schedule's time
  let tasks = [], sum = {}, scale = 1, knobAt = 0;

  function shareOut() {
    const count = code.share_out(...splits[split], workers);
    const numbers = new Float64Array(code.memory.buffer, code.shared_out(), count * 8);
    tasks = Array.from({ length: count }, (_, i) => {
      const [worker, begin, end, left, top, right, bottom, step] = numbers.subarray(8 * i, 8 * i + 8);
      return { worker, begin, end, left, top, right, bottom, step };
    });
    const [work, finish, least, most, idle] = new Float64Array(code.memory.buffer, code.summed_up(), 5);
    sum = { work, finish, least, most, idle };
    scale = finish;
  }
  shareOut();

  const moment = () => at * scale;
  const stateOf = ({ begin, end }) => (end <= moment() ? "done" : begin <= moment() ? "now" : "later");

  // All rectangles of a kind in one path. kindOf(task) gives its class, and how opaque it is.
  function drawTasks(boxes, kindOf, gap) {
    const paths = {};
    for (const task of tasks) {
      const kind = kindOf(task).join(" ");
      for (const [x, y, width, height] of boxes(task)) {
        const across = Math.max(width - gap, 0.3).toFixed(2), down = Math.max(height - gap, 0.3).toFixed(2);
        paths[kind] = `${paths[kind] ?? ""}M${x.toFixed(2)} ${y.toFixed(2)}h${across}v${down}h-${across}z`;
      }
    }
    return Object.entries(paths).map(([kind, d]) => {
      const [state, opacity] = kind.split(" ");
      return shape("path", { d, class: `task ${state}`, "fill-opacity": opacity });
    }).join("");
  }

  // The more a tile costs for its pixels, the darker it is.
  function drawPicture({ picture }) {
    const unit = picture.width / 1920;
    const boxes = ({ left, top, right, bottom, step }) => {
      const height = step === 1 ? bottom - top : 1, strips = [];
      for (let y = top; y < bottom; y += height * step)
        strips.push([picture.left + left * unit, y * unit, (right - left) * unit, height * unit]);
      return strips;
    };
    const density = ({ begin, end, left, top, right, bottom, step }) =>
      ((end - begin) * step) / ((right - left) * (bottom - top));
    const most = Math.max(...tasks.map(density));
    const shade = (task) => Math.round(5 * Math.sqrt(density(task) / most)) / 5;
    const kindOf = (task) => [stateOf(task), (0.2 + 0.7 * shade(task)).toFixed(2)];
    return drawTasks(boxes, kindOf, split === "interleaved" ? 0 : 0.6);
  }

  function drawChart({ chart, to, width }) {
    const height = chart.height / workers, thick = height > 3 ? height - 1 : height;
    const column = (time) => to([time / scale, 0])[0];
    const boxes = ({ worker, begin, end }) => [
      [column(begin), chart.top + worker * height, column(end) - column(begin), thick],
    ];
    const bottom = chart.top + chart.height + 8;
    const line = (time, kind) => segment([column(time), chart.top - 6], [column(time), bottom], kind);
    const late = at > 0.8, time = `${number(moment() / 1000, 1)} ms`;
    return [
      drawTasks(boxes, (task) => [stateOf(task), 0.65], 0.5),
      line(sum.least, "rule three dashed"),
      line(moment(), "rule four"),
      label([column(moment()) + (late ? -14 : 14), knobAt + 6], time, late ? "end" : ""),
    ].join("");
  }

  return {
    title: "A picture's tiles, shared out among the cores of a processor",
    caption: `Drag the red line through time, or change the number of cores. Each bar is a tile of lesson 10's picture at 1920 × 1080, as long as one core was measured to draw it; the next tile goes to the core that is free first. Darker tiles cost more for their size. No schedule ends before the green line.`,
    layout: (width) => {
      const picture = { left: 0, width };
      if (width > 500) [picture.width, picture.left] = [width * 0.66, width * 0.17];
      const top = (picture.width * 1080) / 1920 + 20, chart = { top, height: 150 };
      return {
        picture, chart,
        height: top + chart.height + 26,
        to: ([x, y]) => [x * (width - 10), y],
        from: ([x, y]) => [x / (width - 10), y],
      };
    },
    draw: (layout) => {
      knobAt = layout.chart.top + layout.chart.height + 12;
      return drawPicture(layout) + drawChart(layout);
    },
    readout: () => {
      const ms = (time) => `${number(time / 1000, 1)} ms`;
      return [
        `T<sub>1</sub> = ${ms(sum.work)}`,
        `T<sub>${workers}</sub> = <b>${ms(sum.finish)}</b>`,
        `speedup <b>${number(sum.work / sum.finish, 1)}</b>`,
        `idle ${number(100 * sum.idle, 1)} %`,
        `<span class="three">at least ${ms(sum.least)}</span>`,
        `Graham's bound ${ms(sum.most)}`,
      ];
    },
    handles: [
      {
        name: "Time",
        step: 0.01,
        at: () => [at, knobAt],
        text: () => `${number(moment() / 1000, 1)} ms`,
        move: (x) => (at = clamp(x, 0, 1)),
      },
    ],
    controls: [
      {
        label: "Cores", min: 0, max: 7, step: 1, value: Math.log2(workers), text: (n) => String(2 ** n),
        set: (n) => {
          workers = 2 ** n;
          shareOut();
        },
      },
      {
        label: "Split",
        value: split,
        options: [
          ["rows", "rows"], ["interleaved", "interleaved"],
          ["256", "tiles of 256"], ["128", "128"], ["64", "64"], ["32", "32"],
        ],
        set: (value) => {
          split = value;
          shareOut();
        },
      },
    ],
  };
});
