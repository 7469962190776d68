// What the theme leaves out for screen readers and keyboards: names, roles, and tables that scroll with keys.

function complete() {
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
  // the button to copy is no place to navigate to
  for (const nav of document.querySelectorAll(".md-code__nav")) nav.setAttribute("role", "none");
  for (const table of document.querySelectorAll(".md-typeset__scrollwrap"))
    if (table.scrollWidth > table.clientWidth) table.tabIndex = 0;
    else table.removeAttribute("tabindex");
}

complete();
// the theme makes the buttons and wraps the tables later
new MutationObserver(complete).observe(document.body, { childList: true, subtree: true });
addEventListener("resize", complete);
