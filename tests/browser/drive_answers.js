// Operates a page of answers about one body, and prints "ok ..." or "FAIL ..." for each check, then "done".
(function () {
  const { check, equal, press } = driven,
    { answersPage } = answers_js,
    { answers, view, rows } = answersPage,
    { byId } = dom_js,
    current = () => document.querySelector("tr[aria-current]"),
    facts = () => [...document.querySelectorAll("#item-facts dd")].map((d) => d.textContent).join();

  function opens() {
    check(answers.count > 2, "there are answers", answers.count);
    equal(current().dataset.to, `item ${answers.numbers[0]}`, "the first one is selected, in the table");
    equal(location.hash, `#item=${answers.numbers[0]}`, "and in the address");
    equal(byId("item").value, String(answers.numbers[0]), "and beside the view");
    equal(facts(), [...current().cells].slice(1).map((c) => c.textContent).join(), "with the facts of its row");
    equal(document.querySelectorAll("tr[data-to^=item]").length, answers.count, "each has a row");
  }

  function keys() {
    press("ArrowRight");
    equal(location.hash, `#item=${answers.numbers[1]}`, "arrow right goes to the next");
    press("ArrowLeft");
    press("ArrowLeft");
    equal(location.hash, `#item=${answers.numbers[0]}`, "arrow left goes back, and stops at the first");
    rows.get(`item ${answers.numbers[2]}`).click();
    equal(answersPage.items.join(), "2", "a click on a row selects");
    byId("item").value = "4000000000";
    byId("item").onchange();
    equal(byId("item-state").textContent, "not on this page", "an unknown number is refused");
    equal(answersPage.items.join(), "2", "and the selection stays");
    const faces = answers.facesOf(2);
    press("i");
    view.draw();
    equal(view.views[0].real.mesh.geometry.drawRange.count / 3, faces.length, "isolating shows its faces alone");
    press("i");
    press("g");
    press("f");
    press("F");
  }

  /** Each answer that is alone at its place on the screen is selected by a click there. */
  function clicks() {
    const box = byId("view-canvas").getBoundingClientRect();
    let selected = 0;
    for (let i = 0; i < answers.count; i++) {
      const ends = answers.endsOf(i),
        second = answers.hasPoints ? 0 : 3,
        midpoint = [0, 1, 2].map((k) => (ends[k] + ends[second + k]) / 2),
        at = new THREE.Vector3(...midpoint).project(view.camera.camera),
        [x, y] = [box.left + (box.width * (1 + at.x)) / 2, box.top + (box.height * (1 - at.y)) / 2];
      const near = view.nearestAnswer(x, y);
      check(near >= 0, `answer ${i} is found where it is drawn`, near);
      if (near !== i) continue; // another one is in front of it
      for (const type of ["pointerdown", "click"]) byId("view-canvas").dispatchEvent(new MouseEvent(type, { clientX: x, clientY: y, bubbles: true }));
      selected += answersPage.items.join() === String(i);
    }
    check(selected > answers.count / 4, "clicks select answers", `${selected} of ${answers.count}`);
  }

  function groups() {
    if (!answers.group) return;
    const last = answers.groups[answers.count - 1],
      row = rows.get(`group ${last}`);
    row.click();
    equal(location.hash, `#group=${last}`, "a row of a curve selects it");
    equal(answersPage.items.join(), answers.with((i) => answers.groups[i] === last).join(), "with all its pairs");
    document.querySelector("#item-near button").click();
    equal(answersPage.items.length, 1, "a button selects a pair of it");
    document.querySelector("#item-near button").click();
    equal(location.hash, `#group=${last}`, "and another the curve again");
  }

  driven.run(opens, keys, clicks, groups);
})();
