// Operates the page of a crowd with mouse and keys, and prints "ok ..." or "FAIL ..." for each check, then "done".
(function () {
  const { check, equal, press } = driven,
    { crowdPage } = crowd_js,
    { crowd, state, view, tabs, table } = crowdPage,
    { byId } = dom_js,
    { seek } = page_js,
    words = (id) => byId(id).textContent,
    summary = JSON.parse(byId("summary-data").textContent),
    poses = JSON.parse(byId("trace-data").textContent).metadata.poses,
    rows = () => [...byId("step-table").tBodies[0].rows];

  /** The page has the queries and the poses of the run's own files. */
  function agreesWithTheRun() {
    equal(crowd.steps, summary.steps.length, "all steps are on the page");
    equal(crowd.names.join(), summary.names.join(), "and all bodies");
    let wrong = 0,
      far = 0;
    for (const step of summary.steps) {
      const queries = crowd.queries(step.index);
      wrong += queries.length !== step.queries.length;
      step.queries.forEach((q, i) => {
        const k = queries[i];
        wrong += crowd.a[k] !== q.a || crowd.b[k] !== q.b || crowd.pairs[k] !== q.pairs;
        wrong += crowd.relations[crowd.relation[k]] !== q.relation.replaceAll("_", " ");
      });
      for (let body = 0; body < crowd.count; body++) {
        const pose = poses[step.index][body];
        [...crowd.pose(body, step.index)].forEach((x, i) => (far += i % 4 !== 3 && Math.abs(x - pose[i]) > 1e-6));
      }
    }
    equal(wrong, 0, "its queries are those of the summary");
    equal(far, 0, "its poses are those of the trace");
  }

  function followsTheStep() {
    for (const key of ["Home", "ArrowRight", "]", "ArrowRight"]) press(key);
    equal(state.step, 3, "keys go from step to step");
    equal(byId("step").value, "3", "the slider follows");
    check(words("step-count").startsWith("step 3 (0\u201311)"), "and its text", words("step-count"));
    equal(rows().length, summary.steps[3].queries.length, "the table has the queries of the step");
    const tests = rows().map((row) => Number(row.cells[row.cells.length - 1].textContent.replace(/\D/g, "")));
    check(tests.every((n, i) => i === 0 || n <= tests[i - 1]), "the costly ones first", tests.join());
    byId("step").value = "7";
    byId("step").oninput();
    equal(words("table-step"), "7", "the slider moves the table");
    view.draw();
    const at = new THREE.Vector3().setFromMatrixPosition(view.views[0].group.matrixWorld).toArray(),
      pose = crowd.pose(0, 7);
    check([3, 7, 11].every((i, k) => Math.abs(at[k] - pose[i]) < 1e-6), "and the bodies", at.join());
    press("End");
    equal(state.step, 11, "End goes to the last step");
    document.querySelectorAll(".strip .bar")[2].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    equal(state.step, 2, "a bar of the cost leads to its step");
  }

  function selects() {
    const row = rows()[0];
    row.cells[0].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    const names = [row.cells[0].textContent, row.cells[1].textContent];
    equal(state.bodies.map((b) => crowd.names[b]).join(), names.join(), "a click on a row selects the pair");
    equal(row.getAttribute("aria-selected"), "true", "the row is marked");
    equal(words("picked-title"), names.join(" and "), "the panel names it");
    check(words("picked-facts").includes("distance"), "with its distance", words("picked-facts"));
    check(words("pair-command").endsWith(`--pair "${names.join(",")}"`), "and the command for its run", words("pair-command"));
    press("i");
    view.draw();
    equal(view.views.filter((v) => v.group.visible).length, 2, "isolating shows the two alone");
    press("i");
    press("f");
    press("ArrowDown");
    equal(rows()[1].getAttribute("aria-selected"), "true", "arrow down selects the next pair");
    press("Escape");
    equal(byId("picked").hidden, true, "Escape selects nothing");
  }

  function clicks() {
    press("F");
    view.draw();
    const box = byId("view-canvas").getBoundingClientRect();
    let found = -1,
      at = null;
    for (let i = 1; i < 20 && found < 0; i++)
      for (let j = 1; j < 20 && found < 0; j++) {
        at = { clientX: box.left + (i * box.width) / 20, clientY: box.top + (j * box.height) / 20, bubbles: true };
        found = view.under(at.clientX, at.clientY);
      }
    check(found >= 0, "a body is in the view");
    for (const type of ["pointerdown", "click"]) byId("view-canvas").dispatchEvent(new MouseEvent(type, at));
    equal(state.bodies.join(), String(found), "a click selects it");
    equal(words("picked-title"), crowd.names[found], "and the panel names it");
    const near = crowd.queries(state.step).filter((q) => [crowd.a[q], crowd.b[q]].includes(found));
    equal(byId("near-list").querySelectorAll("button").length, Math.min(12, near.length), "with the bodies near it");
    press("g");
    view.draw();
    const faded = view.views.filter((v) => v.material.opacity < 0.2).length;
    equal(faded, crowd.count - 1, "ghost fades the others");
    press("g");
  }

  function looks() {
    view.draw();
    const open = view.views.filter((v) => v.open);
    equal(open.length, 2, "the open bodies are known");
    check(open.every((v) => v.material.transparent && !v.material.depthWrite), "and are transparent");
    equal(new Set(view.views.map((v) => v.mesh.geometry)).size, crowd.kinds.length, "bodies of a kind share a mesh");
    const meet = crowd.queries(state.step).some((q) => crowd.contacts(q).length > 0);
    equal(view.marks.shown.get("contacts").parts.length > 0, meet, "faces in contact are shown");
    for (const by of ["tests", "meets", "kind"]) {
      press("k");
      equal(state.look.by, by, `K colours ${by}`);
      view.draw();
    }
  }

  function showsTheMatrix() {
    tabs.show("Matrix");
    const q = crowd.queries(state.step)[0],
      box = byId("matrix").getBoundingClientRect(),
      { cell, margin } = crowdPage.matrix;
    byId("matrix").dispatchEvent(
      new MouseEvent("click", { clientX: box.left + margin + (crowd.b[q] + 0.5) * cell, clientY: box.top + (crowd.a[q] + 0.5) * cell, bubbles: true }),
    );
    equal(state.bodies.join(), `${crowd.a[q]},${crowd.b[q]}`, "a click on a cell selects its pair");
    equal(crowdPage.matrix.cells.size, crowd.queries(state.step).length, "it has the queries of the step");
    tabs.show("Pairs");
    const row = document.querySelector("tr[data-to^=bodies]"),
      [step, a, b] = row.dataset.to.split(" ").slice(1).map(Number);
    row.dispatchEvent(new MouseEvent("click", { bubbles: true }));
    equal(`${state.step} ${state.bodies}`, `${step} ${a},${b}`, "a row of all pairs leads to its step and pair");
    tabs.show("Charts");
    seek("step", 5);
    equal(state.step, 5, "a chart leads to its step");
    const address = crowdPage.address();
    press("Home");
    press("Escape");
    location.hash = `#${address}`;
    crowdPage.read();
    equal(crowdPage.address(), address, "the address restores step, selection and tab");
  }

  function fits() {
    if (innerWidth < 960) return;
    equal(document.documentElement.scrollHeight <= innerHeight + 1, true, "the page is one screen");
    const canvas = byId("view-canvas").getBoundingClientRect();
    check(canvas.width > 0.5 * innerWidth && canvas.height > 200, "the view is large", `${canvas.width} x ${canvas.height}`);
  }

  const drawsTheStrip = () => new Promise((done) => setTimeout(done, 500)); // once its size is known
  driven.run(drawsTheStrip, agreesWithTheRun, followsTheStep, selects, clicks, looks, showsTheMatrix, fits);
})();
