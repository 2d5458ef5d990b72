// Maps of fields on the periodic cell: shared zoom and cursor, colours with a movable end.

/** A field as it is embedded: base64 of little-endian whole numbers, of which the greatest possible one is `max`. */
class EmbeddedField {
  constructor({ nx, ny, bits, max, data }) {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    const count = nx * ny;
    const step = max / (2 ** bits - 1);
    this.values = new Float64Array(count);
    for (let i = 0; i < count; i += 1) this.values[i] = step * (bits === 16 ? view.getUint16(2 * i, true) : bytes[i]);
    const least = this.values.reduce((low, value) => Math.min(low, value), max);
    // In full contact, what there is to see is far from zero.
    Object.assign(this, { nx, ny, max, low: least > 0.5 * max ? least : 0 });
  }

  /** The value at a point, in parts of the cell; periodic. */
  at(x, y) {
    const index = (place, n) => Math.min(Math.floor((place - Math.floor(place)) * n), n - 1);
    return this.values[index(y, this.ny) * this.nx + index(x, this.nx)];
  }
}

/** Colours between the given ones, as 256 triples. */
function colourTable(anchors) {
  return Array.from({ length: 256 }, (_, i) => {
    const place = (i / 255) * (anchors.length - 1);
    const below = Math.min(Math.floor(place), anchors.length - 2);
    return anchors[below].map((from, c) => Math.round(from + (place - below) * (anchors[below + 1][c] - from)));
  });
}

/** What several maps show together: the visible part of the cell, and the cursor. Lengths in parts of the cell. */
class SharedView {
  constructor(cursor, smallest) {
    Object.assign(this, { x: 0, y: 0, size: 1, cursor, smallest, pinned: false, listeners: [] });
  }

  change() {
    for (const listener of this.listeners) listener();
  }

  /** Zooms about a point that stays where it is. */
  zoom(factor, [x, y] = this.cursor) {
    const size = Math.min(1, Math.max(this.smallest, this.size * factor));
    const ratio = size / this.size;
    Object.assign(this, { x: x - (x - this.x) * ratio, y: y - (y - this.y) * ratio, size });
    if (size === 1) Object.assign(this, { x: Math.round(this.x), y: Math.round(this.y) });
    this.change();
  }

  reset() {
    Object.assign(this, { x: 0, y: 0, size: 1, pinned: false });
    this.change();
  }
}

/** One map. `reading` makes text of a value, `ends` those at the ends of the colours, which are the values of `span`; the end of these is `movable`. */
class FieldMap {
  constructor({ title, field, colours, span, view, sides, reading, ends, movable = true }) {
    const [low, most] = span ?? [movable ? field.low : 0, field.max];
    Object.assign(this, { title, field, view, side: sides[0], shape: Math.min(4, Math.max(0.25, sides[1] / sides[0])), reading, colours: colourTable(colours), low, top: most });
    this.bitmap = make("canvas", { width: field.nx, height: field.ny });
    this.canvas = make("canvas");
    this.value = make("span", { class: "quiet" });
    this.box = make("div", { class: "map", tabindex: 0, role: "img", "aria-label": title }, this.canvas);
    this.box.style.aspectRatio = 1 / this.shape;
    const bar = make("div", { class: "bar" });
    bar.style.background = `linear-gradient(to right, ${colours.map((c) => `rgb(${c.join(" ")})`).join(", ")})`;
    const greatest = () => (this.top < field.max ? "≥ " : "") + ends(this.low, this.top)[1];
    const [least] = ends(this.low, this.top);
    this.labels = () => [least, greatest()];
    const end = make("span", {}, greatest());
    const slider = make("input", { type: "range", min: 5, max: 100, value: 100, "aria-label": `end of the colours of ${title}` });
    slider.addEventListener("input", () => {
      this.top = low + ((most - low) * slider.value) / 100;
      end.textContent = greatest();
      this.colour();
      this.paint();
    });
    const label = movable ? [make("label", {}, "colours", slider)] : [];
    const scale = make("div", { class: "ends" }, make("span", {}, least), ...label, end);
    this.element = make("figure", {}, make("figcaption", {}, title, this.value), this.box, bar, scale, mapDownload(this));
    this.colour();
    this.listen();
    view.listeners.push(() => this.paint());
    new ResizeObserver(() => this.paint()).observe(this.box);
  }

  /** The field as a picture of one pixel per value, y upwards. */
  colour() {
    const { nx, ny, values } = this.field;
    const context = this.bitmap.getContext("2d");
    const picture = context.createImageData(nx, ny);
    const factor = this.top > this.low ? 255 / (this.top - this.low) : 0;
    const shade = (value) => this.colours[Math.max(0, Math.min(255, Math.round((value - this.low) * factor)))];
    for (let iy = 0; iy < ny; iy += 1) {
      for (let ix = 0; ix < nx; ix += 1) {
        picture.data.set([...shade(values[iy * nx + ix]), 255], 4 * ((ny - 1 - iy) * nx + ix));
      }
    }
    context.putImageData(picture, 0, 0);
  }

  /** Another field of the same cell, in the same colours. */
  show(field) {
    this.field = field;
    Object.assign(this.bitmap, { width: field.nx, height: field.ny });
    this.colour();
    this.paint();
  }

  /** Paints the visible part, with the cursor unless it is a picture to keep. */
  paint(withCursor = true) {
    const { view, canvas } = this;
    const pixels = Math.max(1, Math.round(this.box.clientWidth * (window.devicePixelRatio || 1)));
    const high = Math.max(1, Math.round(pixels * this.shape));
    if (canvas.width !== pixels) Object.assign(canvas, { width: pixels, height: high });
    const context = canvas.getContext("2d");
    const [cell, cellHigh] = [pixels / view.size, high / view.size];
    context.imageSmoothingEnabled = cell < this.field.nx;
    for (let i = Math.floor(view.x); i < view.x + view.size; i += 1) {
      for (let j = Math.floor(view.y); j < view.y + view.size; j += 1) {
        context.drawImage(this.bitmap, (i - view.x) * cell, high - (j + 1 - view.y) * cellHigh, cell, cellHigh);
      }
    }
    if (withCursor) this.paintCursor(context);
    this.paintRuler(context);
    if (this.arrow) this.paintArrow(context);
    this.value.textContent = this.reading(this.field.at(...view.cursor));
  }

  paintCursor(context) {
    const { width: wide, height: high } = this.canvas;
    const [x, y] = this.view.cursor;
    const [left, top] = [((x - this.view.x) / this.view.size) * wide, high - ((y - this.view.y) / this.view.size) * high];
    for (const [colour, width] of [["rgb(255 255 255 / 0.75)", 3], [this.view.pinned ? "#d4002a" : "rgb(20 30 60 / 0.75)", 1]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * (window.devicePixelRatio || 1);
      context.beginPath();
      context.moveTo(left, 0);
      context.lineTo(left, high);
      context.moveTo(0, top);
      context.lineTo(wide, top);
      context.stroke();
    }
  }

  /** A round length, in the corner. */
  paintRuler(context) {
    const unit = window.devicePixelRatio || 1;
    const { width: wide, height: high } = this.canvas;
    const visible = this.side * this.view.size;
    const length = roundBelow(0.3 * visible);
    const [width, margin, text] = [(length / visible) * wide, 10 * unit, si(length, "m")];
    context.font = `${12 * unit}px system-ui, sans-serif`;
    const room = Math.max(width, context.measureText(text).width) + 2 * margin;
    context.fillStyle = "rgb(255 255 255 / 0.85)";
    context.fillRect(0, high - 34 * unit, room, 34 * unit);
    context.fillStyle = "#10151d";
    context.fillText(text, margin, high - 15 * unit);
    context.fillRect(margin, high - 9 * unit, width, 3 * unit);
  }

  /** The direction in which the surface slides, in the other corner. */
  paintArrow(context) {
    const unit = window.devicePixelRatio || 1;
    const [x, y] = [this.arrow[0], -this.arrow[1]];
    const middle = [this.canvas.width - 26 * unit, this.canvas.height - 26 * unit];
    const at = (along, across) => [middle[0] + unit * (along * x - across * y), middle[1] + unit * (along * y + across * x)];
    context.fillStyle = "rgb(255 255 255 / 0.85)";
    context.fillRect(middle[0] - 24 * unit, middle[1] - 24 * unit, 50 * unit, 50 * unit);
    context.strokeStyle = "#10151d";
    context.lineWidth = 3 * unit;
    context.beginPath();
    context.moveTo(...at(-18, 0));
    context.lineTo(...at(18, 0));
    context.moveTo(...at(8, -8));
    context.lineTo(...at(18, 0));
    context.lineTo(...at(8, 8));
    context.stroke();
  }

  /** Point of the cell under the pointer. */
  point(event) {
    const box = this.box.getBoundingClientRect();
    const part = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
    return [this.view.x + part[0] * this.view.size, this.view.y + part[1] * this.view.size];
  }

  listen() {
    const { view, canvas } = this;
    let grip = null;
    let moved = false;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      view.zoom(Math.exp(0.0015 * event.deltaY), this.point(event));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      [grip, moved] = [this.point(event), false];
    });
    canvas.addEventListener("pointermove", (event) => {
      const point = this.point(event);
      if (grip) {
        const far = Math.hypot(point[0] - grip[0], point[1] - grip[1]) > 0.01 * view.size;
        moved = moved || far;
        if (moved) Object.assign(view, { x: view.x + grip[0] - point[0], y: view.y + grip[1] - point[1] });
      } else if (!view.pinned) {
        view.cursor = point;
      }
      view.change();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (!moved) Object.assign(view, { cursor: this.point(event), pinned: !view.pinned });
      grip = null;
      view.change();
    });
    canvas.addEventListener("pointercancel", () => { grip = null; });
    this.box.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const { view } = this;
    const step = 0.02 * view.size;
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowDown: [0, -step], ArrowUp: [0, step] };
    const factors = { "+": 0.8, "=": 0.8, "-": 1.25 };
    if (moves[event.key]) view.cursor = view.cursor.map((place, i) => place + moves[event.key][i]);
    else if (factors[event.key]) view.zoom(factors[event.key]);
    else return;
    event.preventDefault();
    view.change();
  }
}
