// Downloads made in the page: numbers of a chart, and pictures of charts and maps.

/** Saves `url` under `name`. */
function save(url, name) {
  const link = make("a", { download: name, href: url });
  document.body.append(link);
  link.click();
  link.remove();
}

function saveText(text, type, name) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  save(url, name);
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** A name of a file with the words of `text`. */
function fileName(text, ending) {
  return `${text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 60) || "picture"}.${ending}`;
}

function downloadLink(label, save) {
  return make("a", { class: "download", href: "#", role: "button", onclick: (event) => { event.preventDefault(); save(); } }, label);
}

/** The points of a chart in base units, a row per point. */
function chartTable({ series, x, y }) {
  const quoted = (text) => `"${String(text).replace(/"/g, '""')}"`;
  const head = ["series", ...[x, y].map(({ label, unit }) => (unit ? `${label} [${unit}]` : label))].map(quoted);
  const rows = series.flatMap((one, i) => one.points.map((point) => [quoted(one.name || i + 1), ...point.map((value) => value ?? "")]));
  return [head, ...rows].map((row) => `${row.join(",")}\n`).join("");
}

/** A chart as a picture of its own: its styles are in its elements, and its legend is above it. */
function chartSvg({ svg, series }) {
  const copy = svg.cloneNode(true);
  const originals = [...svg.querySelectorAll("*")];
  [...copy.querySelectorAll("*")].forEach((element, i) => {
    const style = getComputedStyle(originals[i]);
    for (const name of ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-size"]) {
      element.setAttribute(name, style.getPropertyValue(name));
    }
  });
  const style = getComputedStyle(document.body);
  const named = series.filter((one) => one.name);
  const row = 18;
  const top = -row * named.length - 4;
  const [width, height] = [CHART.width, CHART.height - top];
  const colour = (one) => (one.colour.startsWith("var(") ? style.getPropertyValue(one.colour.slice(4, -1)) : one.colour);
  const legend = named.flatMap((one, i) => [
    shape("line", { x1: CHART.left, x2: CHART.left + SWATCH, y1: top + row * (i + 0.6), y2: top + row * (i + 0.6), stroke: colour(one), "stroke-width": 2, ...dashes(one) }),
    shape("text", { x: CHART.left + SWATCH + 8, y: top + row * (i + 0.6) + 4, fill: style.color, "font-size": 12 }, one.name),
  ]);
  copy.prepend(shape("rect", { x: 0, y: top, width, height, fill: style.backgroundColor }), ...legend);
  for (const [name, value] of Object.entries({ viewBox: `0 ${top} ${width} ${height}`, width, height, "font-family": "system-ui, sans-serif" })) {
    copy.setAttribute(name, value);
  }
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

/** Saves a chart as PNG, in twice its size. */
async function saveChartPng(chart, name) {
  const { text, width, height } = chartSvg(chart);
  const picture = new Image();
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await picture.decode();
  const canvas = make("canvas", { width: 2 * width, height: 2 * height });
  canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
  save(canvas.toDataURL("image/png"), name);
}

/** The links below a chart. */
function chartDownloads(chart) {
  const name = (ending) => fileName(`${chart.y.label} ${chart.x.label}`, ending);
  return make("span", { class: "downloads" },
    downloadLink("download CSV", () => saveText(chartTable(chart), "text/csv", name("csv"))),
    downloadLink("download SVG", () => saveText(chartSvg(chart).text, "image/svg+xml", name("svg"))),
    downloadLink("download PNG", () => saveChartPng(chart, name("png"))));
}

/** A map as a picture with its title and its colours. */
function mapPicture(map) {
  const wide = Math.max(600, map.canvas.width);
  const high = Math.round(wide * map.shape);
  const canvas = make("canvas", { width: wide, height: high + 96 });
  const context = canvas.getContext("2d");
  context.fillStyle = "#ffffff";
  context.fillRect(0, 0, wide, canvas.height);
  map.paint(false);
  context.drawImage(map.canvas, 0, 40, wide, high);
  map.paint();
  const step = wide / 256;
  map.colours.forEach((colour, i) => {
    context.fillStyle = `rgb(${colour.join(" ")})`;
    context.fillRect(i * step, high + 50, step + 1, 14);
  });
  context.fillStyle = "#10151d";
  context.font = "600 20px system-ui, sans-serif";
  context.fillText(map.title, 4, 27);
  context.font = "16px system-ui, sans-serif";
  const [least, greatest] = map.labels();
  context.fillText(least, 4, high + 86);
  context.textAlign = "right";
  context.fillText(greatest, wide - 4, high + 86);
  return canvas.toDataURL("image/png");
}

/** The link below a map. */
function mapDownload(map) {
  return make("span", { class: "downloads" }, downloadLink("download PNG", () => save(mapPicture(map), fileName(map.title, "png"))));
}
