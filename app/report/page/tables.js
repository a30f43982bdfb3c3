// Elements of the page. Text only ever becomes text nodes: what users called their things stays words.

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  for (const child of children.flat())
    if (child !== null && child !== undefined) made.append(child);
  return made;
}

const page = document.getElementById("page");

function section(title, ...children) {
  const present = children.flat().filter(child => child !== null && child !== undefined);
  if (present.length === 0) return;
  const id = title.toLowerCase().replace(/[^a-z]+/g, "-");
  page.append(element("section", {id}, element("h2", {}, title), present));
}

function paragraph(text, kind = "") { return text ? element("p", kind ? {class: kind} : {}, text) : null; }

function bullets(items) {
  return items.length ? element("ul", {}, items.map(item => element("li", {}, item))) : null;
}

function folded(title, ...children) { return element("details", {}, element("summary", {}, title), children); }

// Tables become cards on a phone: each cell then carries its column's name. columns: {title, number, whole},
// of which the last is never broken into lines.
function table(columns, rows) {
  if (rows.length === 0) return null;
  const classes = column => [column.number ? "number" : "", column.whole ? "whole" : ""].filter(each => each);
  const kind = column => classes(column).length ? {class: classes(column).join(" ")} : {};
  const head = element("tr", {}, columns.map(column => element("th", kind(column), column.title)));
  const body = rows.map(cells => element("tr", {}, cells.map((cell, i) => {
    const empty = cell === "" || cell === null;
    const attributes = {"data-label": columns[i].title};
    const own = classes(columns[i]).concat(empty ? ["empty"] : []);
    if (own.length) attributes.class = own.join(" ");
    return element("td", attributes, cell);
  })));
  return element("table", {class: "cards"}, element("thead", {}, head), element("tbody", {}, body));
}

function tiles(list) {
  const present = list.filter(([value]) => value !== null);
  return present.length ? element("div", {class: "tiles"}, present.map(([value, what]) =>
    element("div", {class: "tile"}, element("b", {}, value), element("span", {}, what)))) : null;
}

function facts(list) {
  return element("dl", {class: "facts"}, list.filter(([, value]) => value).map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, String(value)))));
}
