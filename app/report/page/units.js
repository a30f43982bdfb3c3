"use strict";
// Numbers for people: lengths in mm, angles in mrad, ratios in ppm.

const SHOWN = {m: [1e3, "mm"], rad: [1e3, "mrad"], "1": [1e6, "ppm"]};

// Of a compound unit, as "rad/(N m)" or "1/K", the prefix that makes a figure of one to a thousand of `size`.
function shown(unit, size = 0) {
  if (SHOWN[unit]) return SHOWN[unit];
  const first = unit.split("/")[0];
  if (first === unit || !(size > 0)) return [1, unit];
  if (first === "1") return size < 0.1 ? [1e6, "ppm" + unit.slice(1)] : [1, unit];
  if (first !== "m" && first !== "rad") return [1, unit];
  const prefix = [[1e3, "m"], [1e6, "µ"], [1e9, "n"]].find(([factor]) => factor * size >= 1) || [1e9, "n"];
  return [prefix[0], prefix[1] + unit];
}

function known(number) { return typeof number === "number" && isFinite(number); }

function figure(number, digits = 3) {
  if (!known(number)) return "–";
  if (number !== 0 && Math.abs(number) < 1e-4) return number.toExponential(1).replace("-", "−");
  const text = new Intl.NumberFormat("en", {maximumSignificantDigits: digits, useGrouping: false}).format(number);
  return text.replace("-", "−");
}

// A value beside its sigma: of one that is next to nothing of that, the digits say nothing.
function value_figure(value, sigma) { return figure(Math.abs(value) < 0.01 * sigma ? 0 : value); }

function mm(metres, digits = 3) { return figure(known(metres) ? 1e3 * metres : null, digits); }

// A number with as many decimals as its uncertainty is worth: two digits of that.
function decimals(sigma) {
  return known(sigma) && sigma > 0 ? Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(sigma)))) : 4;
}
function fixed(number, places) { return known(number) ? number.toFixed(places).replace("-", "−") : "–"; }

function percent(share) { return figure(100 * share, share < 0.995 ? 2 : 3) + " %"; }

function probability(p) { return p < 1e-9 ? "below 1e-9" : figure(p, 2); }

function chance(probability) { return fixed(probability, 2); }

function plural(count, one, many) { return count + " " + (count === 1 ? one : many || one + "s"); }
