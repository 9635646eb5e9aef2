"use strict";
// A link to a statement opens its rule.
function openTarget() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const details = target && target.querySelector(":scope > details");
  if (details && target.classList.contains("statement")) details.open = true;
}
addEventListener("hashchange", openTarget);
openTarget();
