// Elements of the page, numbers with units, tick marks.

/** An HTML element. Attributes that begin with "on" are listeners; text among the children stays text. */
function make(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
function shape(tag, attributes = {}, ...children) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/** A table of rows; a cell is text, or a list of a class and text. */
function table(rows, heads) {
  // Only words as long as the name of a file are broken.
  const isLong = (content) => String(content).split(/\s/).some((word) => word.length > 24);
  const cell = (content) => {
    if (Array.isArray(content)) return make("td", { class: content[0] }, content[1]);
    return make("td", isLong(content) ? { class: "long" } : {}, content);
  };
  const head = heads ? [make("tr", {}, ...heads.map((text) => make("th", {}, text)))] : [];
  return make("table", {}, ...head, ...rows.map((row) => make("tr", {}, ...row.map(cell))));
}

const PREFIXES = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

/** The prefixed unit in which `largest` is a number from 1 to 1000. */
function scaleOf(largest, unit) {
  const size = Math.abs(largest);
  const plain = [1, ""];
  const found = size > 0 ? PREFIXES.find(([factor]) => size >= 0.99995 * factor) || PREFIXES[PREFIXES.length - 1] : plain;
  const [factor, prefix] = unit ? found : plain;
  return { factor, unit: prefix + unit };
}

/** Four significant digits, with a true minus sign. */
function digits(value, n = 4) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(n - 1).replace(/\.?0+e/, "e") : String(Number(value.toPrecision(n)));
  return text.replace(/-/g, "\u2212").replace("e+", "e");
}

/** `value` with a prefixed unit: 446.4 kPa. */
function si(value, unit, n = 4) {
  const scale = scaleOf(value, unit);
  return `${digits(value / scale.factor, n)} ${scale.unit}`.trim();
}

/** The largest of 1, 2, 5 times a power of ten that is at most `limit`. */
function roundBelow(limit) {
  const power = 10 ** Math.floor(Math.log10(limit) + 1e-12);
  return power * ([5, 2].find((digit) => digit * power <= limit * (1 + 1e-12)) || 1);
}

/** Round numbers between `low` and `high`, about `n` of them. */
function linearTicks(low, high, n) {
  const step = roundBelow(((high - low) / n) * 1.5);
  const marks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) marks.push(i * step);
  return marks;
}

/** Powers of ten between `low` and `high`; with fewer than three of them also twice and five times these. */
function logTicks(low, high) {
  const marks = (factors) => {
    const found = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e += 1) {
      for (const factor of factors) found.push(factor * 10 ** e);
    }
    return found.filter((mark) => mark >= low * (1 - 1e-9) && mark <= high * (1 + 1e-9));
  };
  const decades = marks([1]);
  if (decades.length < 3) return marks([1, 2, 5]);
  const every = Math.ceil(decades.length / 7);
  return decades.filter((_, i) => i % every === 0);
}
