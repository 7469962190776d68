// What the theme leaves out for screen readers and keyboards: names, roles, and what scrolls with keys: tables, formulas.

function complete() {
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
  // buttons to copy are no places to navigate to, and lists of one navigation are parts of it
  for (const nav of document.querySelectorAll(".md-code__nav, .md-nav .md-nav:not(.md-nav--secondary)")) {
    for (const name of ["aria-label", "aria-labelledby", "aria-expanded"]) nav.removeAttribute(name);
    nav.setAttribute("role", "none");
  }
  for (const wide of document.querySelectorAll(".md-typeset__scrollwrap, math[display=block]"))
    if (wide.scrollWidth > wide.clientWidth) wide.tabIndex = 0;
    else wide.removeAttribute("tabindex");
}

complete();
// the theme makes the buttons and wraps the tables later
new MutationObserver(complete).observe(document.body, { childList: true, subtree: true });
addEventListener("resize", complete);
