// The 3-D view of the heights, on a plain canvas: drawn when it is scrolled to, turned by dragging.

const MOST_FACES = 256;

/** Heights on at most 256 x 256 points; `shade` gives the colour of a point in parts of the cell. */
class Relief {
  constructor({ heights, sides, pressure, colours }) {
    const every = Math.ceil(Math.max(heights.nx, heights.ny) / MOST_FACES);
    const [nx, ny] = [Math.floor(heights.nx / every), Math.floor(heights.ny / every)];
    const longest = Math.max(...sides);
    Object.assign(this, { nx, ny, sides: sides.map((side) => side / longest), yaw: 0.6, tilt: 0.75, exaggeration: 0.2 });
    this.z = new Float64Array(nx * ny);
    const blocks = new Float64Array(nx * ny);
    for (let iy = 0; iy < ny * every; iy += 1) {
      for (let ix = 0; ix < nx * every; ix += 1) {
        const i = Math.floor(iy / every) * nx + Math.floor(ix / every);
        this.z[i] += heights.values[iy * heights.nx + ix] / every ** 2;
        if (pressure) blocks[i] = Math.max(blocks[i], pressure.at((ix + 0.5) / heights.nx, (iy + 0.5) / heights.ny));
      }
    }
    const low = this.z.reduce((a, b) => Math.min(a, b));
    const range = this.z.reduce((a, b) => Math.max(a, b)) - low || 1;
    this.z = this.z.map((z) => (z - low) / range - 0.5);
    this.faces = this.shades(pressure ? { blocks, max: pressure.max } : null, colourTable(colours));
    this.canvas = make("canvas", { tabindex: 0, role: "img", "aria-label": "3-D view of the heights" });
    this.box = make("div", { class: "relief" }, this.canvas);
    this.listen();
  }

  /** The colour of each face in the light of one lamp: grey, and the pressure where there is contact. */
  shades(contact, colours) {
    const { nx, ny, z } = this;
    const faces = new Array(nx * ny);
    // The rms step sets the contrast, so that any surface has light and shadow.
    let squares = 0;
    for (let i = 0; i + 1 < z.length; i += 1) squares += (z[i + 1] - z[i]) ** 2;
    const step = Math.sqrt(squares / z.length) || 1;
    for (let iy = 0; iy + 1 < ny; iy += 1) {
      for (let ix = 0; ix + 1 < nx; ix += 1) {
        const i = iy * nx + ix;
        const light = 0.82 - 0.16 * Math.tanh((0.5 * (z[i + 1] - z[i] + z[i + nx] - z[i])) / step);
        const touches = contact && contact.blocks[i] > 0;
        const part = contact ? 0.25 + 0.75 * (contact.blocks[i] / contact.max) : z[i] + 0.5;
        const colour = contact && !touches ? [200, 206, 214] : colours[Math.round(255 * Math.min(1, part))];
        faces[i] = `rgb(${colour.map((c) => Math.round(Math.min(255, c * light * 1.1))).join(" ")})`;
      }
    }
    return faces;
  }

  /** Draws every `stride`th point, from the back to the front. */
  draw(stride = 1) {
    const { nx, ny, z, canvas, box } = this;
    const wide = Math.max(1, Math.round(box.clientWidth * Math.min(2, window.devicePixelRatio || 1)));
    const high = Math.round(wide * 0.66);
    Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext("2d");
    const [cos, sin] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const [up, away] = [Math.cos(this.tilt) * this.exaggeration, Math.sin(this.tilt)];
    const size = Math.min(0.66 * wide, high * 0.9);
    const place = (ix, iy) => {
      const x = (ix / (nx - 1) - 0.5) * this.sides[0];
      const y = (iy / (ny - 1) - 0.5) * this.sides[1];
      return [wide / 2 + size * (x * cos - y * sin), high / 2 - size * (z[iy * nx + ix] * up + (x * sin + y * cos) * away)];
    };
    const order = (n, backward) => {
      const list = [];
      for (let i = 0; i + stride < n; i += stride) list.push(i);
      return backward ? list.reverse() : list;
    };
    const columns = order(nx, sin > 0);
    context.lineWidth = 0.7;
    for (const iy of order(ny, cos > 0)) {
      for (const ix of columns) {
        context.beginPath();
        context.moveTo(...place(ix, iy));
        context.lineTo(...place(ix + stride, iy));
        context.lineTo(...place(ix + stride, iy + stride));
        context.lineTo(...place(ix, iy + stride));
        context.closePath();
        context.fillStyle = this.faces[iy * nx + ix];
        context.strokeStyle = context.fillStyle;
        context.fill();
        context.stroke();
      }
    }
    canvas.dataset.drawn = "yes";
  }

  /** A coarse picture now, and the fine one when nothing has moved for a while. */
  turn(yaw, tilt) {
    this.yaw += yaw;
    this.tilt = Math.max(0.1, Math.min(1.55, this.tilt + tilt));
    if (!this.waiting) {
      this.waiting = requestAnimationFrame(() => {
        this.waiting = null;
        this.draw(Math.max(1, Math.ceil(Math.max(this.nx, this.ny) / 100)));
      });
    }
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.draw(), 200);
  }

  listen() {
    const { canvas } = this;
    let from = null;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      from = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      this.turn((event.clientX - from[0]) * 0.008, (event.clientY - from[1]) * 0.006);
      from = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { from = null; });
    canvas.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (!turns) return;
      event.preventDefault();
      this.turn(...turns);
    });
  }
}

/** The view with its controls. It costs nothing until it is seen, or printed. */
function reliefView(options, note) {
  const box = make("div", {});
  const section = make("section", {}, make("h2", {}, "3-D view"), box, make("p", { class: "quiet" }, note));
  let relief = null;
  const show = () => {
    if (relief) return;
    relief = new Relief(options);
    const slider = (text, least, most, value, change) => make("label", {}, text, make("input", {
      type: "range", min: least, max: most, step: 0.01, value, oninput: (event) => { change(Number(event.target.value)); relief.turn(0, 0); },
    }));
    const controls = make("div", { class: "controls" },
      slider("height ", 0.02, 0.6, relief.exaggeration, (value) => { relief.exaggeration = value; }),
      slider("view from above ", 0.1, 1.55, relief.tilt, (value) => { relief.tilt = value; }),
      downloadLink("download PNG", () => save(relief.canvas.toDataURL("image/png"), "view-3-d.png")));
    box.replaceChildren(relief.box, controls);
    relief.draw();
    let width = relief.box.clientWidth;
    new ResizeObserver(() => {
      if (relief.box.clientWidth === width) return;
      width = relief.box.clientWidth;
      relief.turn(0, 0);
    }).observe(relief.box);
  };
  box.append(make("div", { class: "relief" }, make("button", { onclick: show }, "draw it")));
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    show();
  });
  observer.observe(section);
  window.addEventListener("beforeprint", show);
  return section;
}
