// Begin of the script: the frame that every page has, and its own part.

function copyButton(text) {
  return make("button", {
    onclick: async (event) => {
      try {
        await navigator.clipboard.writeText(text);
        event.target.textContent = "copied";
      } catch {
        event.target.textContent = "not allowed here; select the text and copy it";
      }
    },
  }, "copy");
}

function commands(list) {
  if (list.length === 0) return [make("p", {}, "Unknown, because the folder has no journal (sweep.jsonl) that this version of rc reads.")];
  return list.flatMap(({ text, note }) => [
    make("p", {}, note), make("pre", {}, text), make("div", { class: "controls" }, copyButton(text)),
  ]);
}

function warnings(texts) {
  if (texts.length === 0) return [];
  return [make("ul", { class: "warnings" }, ...texts.map((text) => make("li", {}, text)))];
}

function showPage() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const tile = ({ name, value }) => make("div", { class: "tile" }, make("b", {}, value), make("span", {}, name));
  const body = { mean: meanPage, result: resultPage, surface: surfacePage, shear: shearPage, study: studyPage, sweep: sweepPage }[data.kind](data);
  const files = data.files.map(({ title, text }) => make("details", {}, make("summary", {}, title), make("pre", {}, text)));
  document.getElementById("page").replaceChildren(
    make("header", {}, make("h1", {}, data.title), make("span", { class: data.good ? "badge" : "badge bad" }, data.status)),
    make("p", { class: "quiet" }, data.subtitle),
    ...warnings(data.warnings),
    make("div", { class: "tiles" }, ...data.tiles.map(tile)),
    ...body,
    make("h2", {}, "Repeat it"),
    ...commands(data.commands),
    make("h2", {}, "Parameters and numbers"),
    ...files,
    make("p", { class: "quiet" }, data.made),
  );
  document.documentElement.dataset.ready = "yes";
}

/** What is folded is printed too. */
function unfoldForPrint() {
  let folded = [];
  window.addEventListener("beforeprint", () => {
    folded = [...document.querySelectorAll("details:not([open])")];
    for (const one of folded) one.open = true;
  });
  window.addEventListener("afterprint", () => { for (const one of folded) one.open = false; });
}

showPage();
unfoldForPrint();
