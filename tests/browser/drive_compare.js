// Clicks rows of the tables of regions of a comparison of two constructions, and prints "ok ..." or "FAIL
// ..." for each check of the views beside each other, then "done".
(function () {
  const { check, equal } = driven,
    views = [...document.querySelectorAll(".views iframe")],
    rows = [...document.querySelectorAll('tr[data-to^="regions "]')];

  /** Returns the title of the selection in a view; empty: nothing is selected. */
  function selected(view) {
    const page = view.contentDocument;
    return page.getElementById("picked").hidden ? "" : page.getElementById("picked-title").textContent;
  }

  /** Waits until a condition holds, at most 20 seconds of the page's time. */
  async function until(condition) {
    for (let i = 0; i < 200 && !condition(); i++) await new Promise((then) => setTimeout(then, 100));
  }

  async function selectsInBoth() {
    equal(views.length, 2, "both runs are beside each other");
    await until(() => views.every((v) => v.contentDocument.querySelector(".instrument")));
    for (const [row, what] of [
      [rows.find((r) => /^regions \d+ \d+$/.test(r.dataset.to)), "at the same place"],
      [rows.find((r) => /^regions \d+ -$/.test(r.dataset.to)), "only in the first run"],
      [rows.find((r) => /^regions - \d+$/.test(r.dataset.to)), "only in the second run"],
    ]) {
      check(row, `there is a row of regions ${what}`);
      row.click();
      const wanted = row.dataset.to.split(" ").slice(1).map((n) => (n === "-" ? "" : `Region ${n}`)),
        found = () => views.map((v) => selected(v).replace(/\s/g, " ").replace(/ of .*/, "")).join(" | ");
      await until(() => found() === wanted.join(" | "));
      equal(found(), wanted.join(" | "), `a click on it selects the regions ${what}`);
      equal(document.querySelectorAll("tr[aria-current]").length, 1, "one row is marked");
      equal(row.getAttribute("aria-current"), "true", "this one");
    }
  }

  driven.run(selectsInBoth);
})();
