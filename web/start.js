// Says at once when a part of the page has failed to load. It is a separate script, because the modules may be missing.
// Without it, and if nothing arrives at all, the notice of index.html shows itself after a while.

{
  const notice = /** @type {HTMLElement} */ (document.getElementById("not-loaded"));

  // Scripts and style sheets have loaded by then, or failed.
  addEventListener("load", () => {
    const styled = getComputedStyle(notice).position === "fixed";
    if (styled && "fleetplan" in window) notice.remove();
    else notice.classList.add("certain");
  });

  notice.querySelector("a")?.addEventListener("click", (event) => {
    event.preventDefault();
    location.reload(); // unlike the link, keeps the fragment, which may be a request
  });
}
