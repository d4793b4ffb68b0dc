"use strict";

/** Numbers that Python packed as base64, of double precision unless said otherwise. */
const unpacked = (text, Kind = Float64Array) =>
  new Kind(Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer);

/** Row k of numbers that lie one after the other, as a plain array. */
const rowOf = (numbers, k, width) => Array.from(numbers.subarray(k * width, (k + 1) * width));

const degrees = (radians) => (180 * radians) / Math.PI;
const radians = (angle) => (angle * Math.PI) / 180;

/** A number with a fixed number of digits, and never "-0". */
const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1");

const element = (tag, className, text) => {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};
