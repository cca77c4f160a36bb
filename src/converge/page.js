"use strict";
// The plot and the choice of pictures: without this script, and in print, a drawing and one pair of
// pictures stand in their place.
const study = JSON.parse(document.getElementById("study").textContent);
const COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];
const SVG = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT] = [1000, 600];
const FRAME = { left: 76, right: 980, top: 14, bottom: 545 };

function draw(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

// Shapes that can be told apart without colours.
function marker(number, x, y, isBelow) {
  if (isBelow) return `M${x - 5} ${y - 4}h10l-5 9z`;
  const shapes = [
    `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z`,
    `M${x - 5} ${y + 4}h10l-5 -9z`,
    `M${x - 4} ${y - 4}h8v8h-8z`,
    `M${x} ${y - 6}l6 6l-6 6l-6 -6z`,
  ];
  return shapes[Math.floor(number / COLORS.length) % shapes.length];
}

class LogScale {
  constructor(values, from, to) {
    let low = Math.log10(Math.min(...values));
    let high = Math.log10(Math.max(...values));
    const room = Math.max(0.05 * (high - low), 0.1);
    Object.assign(this, { low: low - room, high: high + room, from, to });
  }
  place(value) {
    return this.from + ((Math.log10(value) - this.low) / (this.high - this.low)) * (this.to - this.from);
  }
  ticks() {
    const of = this.high - this.low < 2 ? [1, 2, 5] : [1];
    const ticks = [];
    for (let decade = Math.floor(this.low); decade <= this.high; decade++) {
      for (const times of of) {
        const value = times * 10 ** decade;
        if (Math.log10(value) >= this.low && Math.log10(value) <= this.high) ticks.push(value);
      }
    }
    return ticks;
  }
}

const shortest = (value) =>
  value >= 1e-3 && value < 1e5 ? String(Number(value.toPrecision(3))) : value.toExponential(0);

class Plot {
  constructor(area) {
    this.area = area;
    this.details = document.getElementById("details");
    this.x = document.getElementById("x-axis");
    this.y = document.getElementById("y-axis");
    this.shown = study.series.map(() => true);
    this.current = [0, 0];
    this.x.addEventListener("change", () => this.update());
    this.y.addEventListener("change", () => this.update());
    this.legend(document.getElementById("legend"));
    this.update();
  }

  legend(list) {
    study.series.forEach((series, i) => {
      const label = document.createElement("label");
      const box = document.createElement("input");
      box.type = "checkbox";
      box.checked = true;
      box.addEventListener("change", () => {
        this.shown[i] = box.checked;
        this.update();
      });
      const svg = document.createElementNS(SVG, "svg");
      svg.setAttribute("viewBox", "0 0 14 14");
      draw(svg, "path", { d: marker(i, 7, 7), fill: COLORS[i % COLORS.length] });
      label.append(box, svg, series.name);
      list.append(label);
    });
  }

  update() {
    const [x, y] = [this.x.value, this.y.value];
    const floor = study.floors[y];
    const known = study.series.flatMap((series, i) =>
      series.points
        .map((point, j) => ({ i, j, x: point.x[x], y: point.y[y] ?? floor, isBelow: point.y[y] === null, text: point.text }))
        .filter((point) => point.x > 0 && point.y > 0 && this.shown[i]),
    );
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", "Error against time; arrow keys go from point to point");
    this.area.replaceChildren(svg);
    this.points = known;
    if (known.length === 0) return;
    const across = new LogScale(known.map((p) => p.x), FRAME.left, FRAME.right);
    const up = new LogScale([...known.map((p) => p.y), ...(floor > 0 ? [floor] : [])], FRAME.bottom, FRAME.top);
    this.axes(svg, across, up);
    this.guides(svg, across, up, known);
    if (floor > 0) {
      const at = up.place(floor);
      draw(svg, "path", { class: "floor", d: `M${FRAME.left} ${at}H${FRAME.right}` });
      draw(svg, "text", { class: "note", x: FRAME.left + 6, y: at - 5 }, "noise floor of the reference: errors below are not known");
    }
    study.series.forEach((series, i) => {
      const own = known.filter((p) => p.i === i);
      const places = own.map((p) => `${across.place(p.x)} ${up.place(p.y)}`);
      if (places.length > 1) draw(svg, "path", { class: "curve", d: "M" + places.join("L"), stroke: COLORS[i % COLORS.length] });
    });
    for (const point of known) this.point(svg, point, across.place(point.x), up.place(point.y));
    this.focusable(known.find((p) => p.i === this.current[0] && p.j === this.current[1]) ?? known[0]);
  }

  axes(svg, across, up) {
    const { left, right, top, bottom } = FRAME;
    for (const value of across.ticks()) {
      const at = across.place(value);
      draw(svg, "path", { class: "grid", d: `M${at} ${top}V${bottom}` });
      draw(svg, "text", { class: "ticks", x: at, y: bottom + 18, "text-anchor": "middle" }, shortest(value));
    }
    for (const value of up.ticks()) {
      const at = up.place(value);
      draw(svg, "path", { class: "grid", d: `M${left} ${at}H${right}` });
      draw(svg, "text", { class: "ticks", x: left - 6, y: at + 4, "text-anchor": "end" }, shortest(value));
    }
    draw(svg, "path", { class: "axis", d: `M${left} ${top}V${bottom}H${right}` });
    const name = (select) => select.selectedOptions[0].textContent;
    draw(svg, "text", { class: "name", x: 0.5 * (left + right), y: HEIGHT - 12, "text-anchor": "middle" }, name(this.x));
    draw(svg, "text", { class: "name", transform: `translate(16 ${0.5 * (top + bottom)}) rotate(-90)`, "text-anchor": "middle" }, name(this.y));
  }

  // Known slopes, and the points that no other beats.
  guides(svg, across, up, known) {
    const front = [];
    for (const point of known.filter((p) => !p.isBelow).sort((a, b) => a.x - b.x || a.y - b.y)) {
      if (front.length === 0 || point.y < front.at(-1).y) front.push(point);
    }
    if (front.length === 0) return;
    const [start, end] = [front[0], 10 ** across.high];
    for (const [name, slope] of study.guides) {
      const last = Math.min(end, start.x * (10 ** up.low / start.y) ** (1 / slope));
      const height = up.place(start.y * (last / start.x) ** slope);
      draw(svg, "path", { class: "guide", d: `M${across.place(start.x)} ${up.place(start.y)}L${across.place(last)} ${height}` });
      draw(svg, "text", { class: "note", x: across.place(last) - 6, y: height - 6, "text-anchor": "end" }, name);
    }
    const places = front.map((p) => `${across.place(p.x)} ${up.place(p.y)}`);
    draw(svg, "path", { class: "front", d: "M" + places.join("L") });
  }

  point(svg, point, x, y) {
    const group = draw(svg, "g", { class: "point", tabindex: -1, role: "img", "aria-label": point.text });
    const color = COLORS[point.i % COLORS.length];
    const isHollow = point.isBelow;
    draw(group, "path", { d: marker(point.i, x, y, isHollow), fill: isHollow ? "none" : color, stroke: color });
    draw(group, "circle", { class: "halo", cx: x, cy: y, r: 9 });
    draw(group, "title", {}, point.text);
    point.element = group;
    group.addEventListener("pointerenter", () => (this.details.textContent = point.text));
    group.addEventListener("focus", () => {
      this.details.textContent = point.text;
      this.focusable(point);
    });
    group.addEventListener("keydown", (event) => this.key(event, point));
  }

  // One stop for the tabulator, as a list has.
  focusable(point) {
    for (const { element } of this.points) element.setAttribute("tabindex", -1);
    point.element.setAttribute("tabindex", 0);
    this.current = [point.i, point.j];
  }

  key(event, point) {
    const own = this.points.filter((p) => p.i === point.i);
    const curves = [...new Set(this.points.map((p) => p.i))];
    const at = own.indexOf(point);
    const nearest = (step) => {
      const other = curves[(curves.indexOf(point.i) + step + curves.length) % curves.length];
      const distance = (p) => Math.abs(Math.log(p.x / point.x));
      return this.points.filter((p) => p.i === other).sort((a, b) => distance(a) - distance(b))[0];
    };
    const next = {
      ArrowRight: () => own[at + 1],
      ArrowLeft: () => own[at - 1],
      Home: () => own[0],
      End: () => own.at(-1),
      ArrowUp: () => nearest(-1),
      ArrowDown: () => nearest(1),
    }[event.key];
    if (!next) return;
    event.preventDefault();
    next()?.element.focus();
  }
}

// Two methods and a time: their pictures and error maps.
function pictures() {
  const selects = ["left-method", "right-method", "time"].map((id) => document.getElementById(id));
  const sides = ["left", "right"];
  const show = () => {
    const time = selects[2].value;
    sides.forEach((side, i) => {
      const view = study.views[study.choices[time][selects[i].value]];
      const figure = document.querySelector(`.slider .${side}`);
      const map = document.querySelectorAll(".maps .map")[i];
      for (const [of, source] of [[figure, view.picture], [map, view.errors]]) {
        of.querySelector("img").src = source;
        of.querySelector("img").alt = view.text;
        of.querySelector("figcaption").textContent = view.text;
      }
    });
  };
  for (const select of selects) select.addEventListener("change", show);
  if (study.views.length > 0) show();
}

new Plot(document.getElementById("plot"));
pictures();
