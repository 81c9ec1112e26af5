// Numbers as a person reads them, by the rule of twin/num.py, for the report's page and the workbench.

/** What was measured or estimated, to so many significant digits with its known zeros; a power of ten only below 1e-4 and from 1e12 on; thousands with a thin space. */
function num(x, digits = 3) {
  if (x === null || x === undefined || !isFinite(x)) return "–";
  if (x === 0) return "0";
  const [mantissa, power] = x.toExponential(digits - 1).split("e").map(Number);
  if (power < -4 || power >= 12) return `${mantissa.toFixed(digits - 1)}e${power}`;
  return thin(Number(`${mantissa}e${power}`).toFixed(Math.max(digits - 1 - power, 0)));
}

/** What was declared or stands on an axis: at most so many digits, its whole part whole, no further zeros. */
function asGiven(x, digits = 6) {
  if (x === null || x === undefined || !isFinite(x)) return "–";
  const whole = Math.abs(x) >= 10 ** digits && Math.abs(x) < 1e12;
  const [head, power] = (whole ? thin(x.toFixed(0)) : num(x, digits)).split("e");
  return (head.includes(".") ? head.replace(/\.?0+$/, "") : head) + (power ? `e${power}` : "");
}

/** The marks of an axis, evenly apart, each with as many digits as tell it from the next: 57.69, 57.7. */
function onAxis(marks) {
  const step = marks.length > 1 ? Math.abs(marks[1] - marks[0]) : Infinity;
  return marks.map((v) => asGiven(v, Math.max(4, Math.floor(Math.log10(Math.abs(v) / step || 1)) + 4)));
}

const thin = (text) => text.replace(/\B(?<!\.\d*)(?=(\d{3})+(?!\d))/g, "\u202f");

const READABLE = { rad: ["deg", 180 / Math.PI], "rad/s": ["deg/s", 180 / Math.PI], "1/rad": ["1/deg", Math.PI / 180] };

/** A number with its unit and what else is in that unit, as a person reads it: angles in degrees; no unit is empty. */
function readable(p) {
  const [unit, k] = READABLE[p.unit] || [p.unit, 1], told = { ...p, unit: unit === "-" ? "" : unit };
  for (const key of ["value", "sd", "low95", "high95", "before", "in_ship_file", "slope"]) if (typeof p[key] === "number") told[key] = k * p[key];
  return told;
}

const withUnit = (text, p) => `${text} ${p.unit}`.trim();
