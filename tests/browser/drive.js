// Operates a run's page with mouse and keys, and prints "ok ..." or "FAIL ..." for each check, then "done".
(async function () {
  const { run } = scene_js,
    { byId, digits } = dom_js,
    { data, moment, seek, show } = page_js,
    { NONE, lastAtMost } = scene_run_js,
    { sumsOfGroups } = scene_bodies_js;
  const lines = [],
    wait = (ms) => new Promise((then) => setTimeout(then, ms));
  // Time is virtual here and does not wait for pictures: the script requests them.
  const frame = async () => {
    await wait(20);
    if (run.view) run.view.draw();
  };
  const check = (is, what, found = "") =>
    lines.push(`${is ? "ok" : "FAIL"} ${what}${is ? "" : `: ${found}`}`);
  const equal = (found, wanted, what) => check(found === wanted, what, `found ${found}, wanted ${wanted}`);
  const press = (key, shiftKey = false) =>
    document.body.dispatchEvent(
      new KeyboardEvent("keydown", { key, shiftKey, bubbles: true, cancelable: true }),
    );
  const input = (id, value) => {
    byId(id).value = value;
    byId(id).dispatchEvent(new Event("input", { bubbles: true }));
  };
  const shownRows = () => document.querySelectorAll("#event-body .row").length;
  const ofKind = (kind) => run.events.kind.reduce((n, k) => n + (k === kind ? 1 : 0), 0);
  const recordedSize = (i) => run.wrappers.sizes[run.events.side[i]] === run.events.boundary[i];

  function opensAtFirstContact() {
    const { events, selection } = run;
    equal(events.kind[selection.event], events.CONTACT, "opens at a contact");
    equal(events.kind.indexOf(events.CONTACT), selection.event, "which is the first");
    equal(data.frames[parseInt(byId("count").textContent) - 1].step, events.stepNumber(selection.event), "frames stand at the same step");
    check(
      byId("view-caption").textContent.includes("contact"),
      "the caption says so",
      byId("view-caption").textContent,
    );
  }

  function replaysAsRecorded() {
    const { events, selection, wrappers } = run,
      changes = [...events.kind.keys()].filter((i) => events.changesWrapper(i));
    check(changes.length > 20, "wrappers change", changes.length);
    for (const [order, list] of [
      ["forward", changes],
      ["backward", changes.slice().reverse()],
    ]) {
      const wrong = list.filter((i) => {
        wrappers.seek(i);
        return !recordedSize(i);
      });
      equal(wrong.length, 0, `wrappers have as many faces as recorded, ${order}`);
    }
    selection.goTo(selection.event);
  }

  async function slides() {
    const { events, selection, timeline } = run,
      first = timeline.firstHere,
      change = [...Array(timeline.lastHere - first).keys()]
        .reverse()
        .find((i) => events.changesWrapper(first + i));
    input("event", change);
    await frame();
    equal(selection.event, first + change, "the slider moves to its event");
    check(
      recordedSize(selection.event),
      "and the wrapper has the faces that the trace says",
      run.wrappers.sizes,
    );
    check(
      byId("event-facts").textContent.includes(digits(run.events.boundary[selection.event])),
      "the panel says how many",
      byId("event-facts").textContent,
    );
    input("step", 0);
    equal(events.step(selection.event), 0, "the slider of steps moves to its step");
    check(document.querySelector("#event-body [aria-selected=true]"), "the table shows the event");
  }

  async function clicks() {
    run.timeline.toStep(run.events.firstOfStep.length - 1);
    run.view.frameAll();
    await frame();
    const box = byId("view-canvas").getBoundingClientRect(),
      points = [];
    for (let x = 0.1; x < 1; x += 0.05)
      for (let y = 0.1; y < 1; y += 0.1)
        points.push([Math.round(box.left + x * box.width), Math.round(box.top + y * box.height)]);
    const at = points.find(([x, y]) => {
      const hit = run.view.picker.under(x, y);
      return hit && !run.events.bodies[hit.side].isReal(hit.face);
    });
    check(at, "a pseudo face can be seen");
    if (!at) return;
    for (const type of ["pointerdown", "click"])
      byId("view-canvas").dispatchEvent(
        new MouseEvent(type, { clientX: at[0], clientY: at[1], bubbles: true }),
      );
    await frame();
    check(
      /^Pseudo face/.test(byId("picked-title").textContent),
      "a click on it fills the panel",
      byId("picked-title").textContent,
    );
    for (const word of ["layer", "lids", "floor", "tests", "hits", "misses"])
      check(byId("picked-facts").textContent.includes(word), `with ${word}`);
    byId("picked-events").click();
    equal(run.tabs.shown, "Events", "its button shows the events");
    check(run.table.rows.length < run.events.count, "its button filters the table", run.table.rows.length);
    byId("filter-clear").click();
  }

  function filters() {
    const { events, table } = run;
    equal(table.rows.length, events.count, "all events are listed");
    check(shownRows() > 3 && shownRows() < 60, "and only some rows made", shownRows());
    input("filter-kind", events.REFINE);
    equal(table.rows.length, ofKind(events.REFINE), "the filter of kinds leaves the refinements");
    input("filter-side", "1");
    check(table.rows.length > 0 && table.rows.every((i) => events.side[i] === 1), "that of sides those of B");
    input("filter-level", "2-3");
    check(
      table.rows.length > 0 && table.rows.every((i) => events.level(i) >= 2 && events.level(i) <= 3),
      "that of levels those at 2 and 3",
    );
    byId("filter-clear").click();
    const contact = events.kind.indexOf(events.CONTACT),
      [a, b] = events.faces(contact);
    input("filter-pair", `${a.face}, ${b.face}`);
    check(
      table.rows.length > 0 &&
        table.rows.every((i) => events.faces(i)[0].face === a.face && events.faces(i)[1].face === b.face),
      "that of pairs one pair",
    );
    input("filter-pair", "x");
    equal(byId("filter-pair").getAttribute("aria-invalid"), "true", "nonsense is marked");
    byId("filter-clear").click();
    input("filter-kind", events.REFINE);
    press("ArrowDown");
    equal(events.kind[run.selection.event], events.REFINE, "the arrow keys walk along what is listed");
    byId("filter-clear").click();
    document.querySelectorAll("#event-body .row")[2].click();
    equal(run.selection.event, run.table.rows[run.table.first + 2], "a click on a row selects its event");
  }

  async function presses() {
    const { selection, view } = run,
      before = selection.event;
    press("ArrowRight");
    equal(selection.event, before + 1, "an arrow key moves by one event");
    press("ArrowLeft", true);
    equal(selection.event, Math.max(0, before - 9), "with shift by ten");
    press("g");
    equal(byId("ghost").getAttribute("aria-pressed"), "true", "g makes ghosts");
    await frame();
    equal(view.views[0].materials.real.transparent, true, "of the bodies");
    press("g");
    run.selection.pickRegion(0, run.events.bodies[0].regionCount - 1);
    press("i");
    await frame();
    check(
      view.views[0].pieces.some((p) => p.triangles > 0),
      "i isolates the selected region",
    );
    press("i");
    equal(byId("explode").value, "0", "nothing is exploded at first");
    press("x");
    await frame();
    check(
      view.views.every((v) => v.pieces.some((p) => p.triangles > 0)),
      "x takes the wrappers apart",
    );
    equal(byId("explode").value, "0.1", "by a little");
    press("x", true);
    equal(view.now.explode, 0, "shift x takes it back");
    press("n");
    await frame();
    check(
      view.views.every((v) => v.boxLines),
      "n shows the boxes of the trees",
    );
    press("n", true);
    press("?");
    equal(byId("help").open, true, "? lists the keys");
    byId("help").close();
    press("o");
    await frame();
    equal(view.camera.camera.isOrthographicCamera, true, "o looks along parallels");
    press("o");
    press("v");
    await frame();
    lines.push(`camera ${byId("camera-json").textContent}`);
  }

  /** Events of the walk through the trees: nodes have boxes, phases have names. */
  async function walks() {
    const { events, selection, view } = run;
    const pair = events.kind.findIndex((_, i) => events.about(i, "node").length === 2);
    check(pair >= 0, "there are pairs of nodes");
    selection.goTo(pair);
    await frame();
    equal(view.marks.shown.get("nodes").parts.length, 2, "whose boxes are shown");
    check(byId("event-facts").textContent.includes("result"), "with what became of the pair");
    const phase = events.kinds.findIndex((k) => k.name === "begin");
    selection.goTo(events.kind.indexOf(phase));
    check(
      byId("event-facts").textContent.includes("tree walk"),
      "a phase has a name",
      byId("event-facts").textContent,
    );
  }

  /** Why: of an event's faces, of two that are chosen, and of a step in which the bodies are apart. */
  async function explains() {
    const { events, selection, view, why } = run,
      contact = events.kind.indexOf(events.CONTACT);
    selection.goTo(contact);
    await frame();
    const text = () => byId("why").textContent;
    equal(byId("why").hidden, false, "a contact is explained");
    check(/The faces (cross|touch)\. Decided by /.test(text()), "with a verdict", text());
    const rows = byId("why-way").querySelectorAll("tr");
    check(rows.length > 1 && rows[0].textContent.startsWith("0, 0"), "the way begins at the roots", rows.length);
    check(byId("why-facts").textContent.includes("contact"), "the contact is shown");
    check(view.whyMarks.group.children.length > 0, "and shown");
    const [a, b] = events.faces(contact).map((f, side) => events.bodies[side].firstSimplex[f.face]);
    equal(
      byId("why-command").textContent.split(" --run ")[1].split(" ").slice(1).join(" "),
      `--step ${events.stepNumber(contact)} --pair ${a},${b}`,
      "the command names step and pair",
    );
    lines.push(`command ${byId("why-command").textContent}`);
    lines.push(`verdict ${byId("why-verdict").textContent}`);
    rows[0].querySelector("button").click();
    await frame();
    equal(view.marks.shown.get("way").parts.length, 2, "a click on a row shows its boxes");
    rows[0].querySelector("button").click();
    const hiding = byId("why-regions").querySelector("button");
    hiding.click();
    equal(selection.picked.face, NONE, "a click on a region selects it");
    press("Escape");
    const meets = (i) => why.explanations.pair(events.stepNumber(i), [events.a[i], events.b[i]])?.meet;
    const apart = [...events.kind.keys()].find((i) => events.kind[i] === events.FACE_TEST && meets(i) === 0);
    check(apart !== undefined, "pairs that do not meet are explained too");
    selection.goTo(apart);
    await frame();
    check(/disjoint.*distance/s.test(text()), "with their distance", text());
    selection.goTo(events.endOfStep(events.step(contact)) - 1);
    selection.pickFace(0, 0);
    selection.pickFace(1, 0);
    await frame();
    check(/--pair 0,0$/.test(byId("why-command").textContent), "two picked faces are explained");
    press("Escape");
    const empty = [...why.explanations.steps.keys()];
    check(empty.length > 0, "steps without contact are explained");
    selection.goTo(events.endOfStep(lastAtMost(events.stepNumbers, empty[0])) - 1);
    await frame();
    check(/What separates the bodies.*Apart/s.test(text()), "in words", text());
    check(view.whyMarks.group.children.length > 0, "and in the view");
    press("y");
    await frame();
    equal(view.whyMarks.group.children.length, 0, "y hides it");
    press("y");
  }

  /** Parts of the work: a click on one lists its events. */
  async function shares() {
    const { events, table, work } = run,
      groups = () => [...byId("work-chart").querySelectorAll("[data-parts]")],
      named = (name) => groups().find((g) => g.querySelector("title").textContent.startsWith(`${name}:`));
    equal(byId("work").hidden, false, "the work is charted");
    check(named("walk of the bodies") && named("boxes of nodes"), "with phases and what decided in them");
    const of = (parts) => events.work.reduce((n, w) => n + (parts.includes(w) ? 1 : 0), 0);
    const press = (name) => named(name).dispatchEvent(new MouseEvent("click", { bubbles: true }));
    press("boxes of nodes");
    const parts = named("boxes of nodes").dataset.parts.split(" ").map(Number);
    equal(table.rows.length, of(parts), "a click on a part lists its events");
    equal(table.rows.length, work.work.outcomes[parts[0]].events, "as many as the part says");
    equal(named("boxes of nodes").getAttribute("aria-pressed"), "true", "and marks it");
    press("boxes of nodes");
    equal(table.rows.length, events.count, "a second click lists all");
    press("walk of the bodies");
    check(table.rows.length > of(parts), "a phase has the events of its parts", table.rows.length);
    check(!named("relation") && named("boxes of nodes"), "and fills the chart");
    byId("filter-clear").click();
    equal(table.rows.length, events.count, "show all shows all");
    run.selection.goTo(events.work.indexOf(parts[0]));
    check(named("boxes of nodes").classList.contains("here"), "the chart marks the part of the event");
  }

  /** The same chart for one step: shares of all steps are those of the run. */
  async function sharesOfSteps() {
    const { work, timeline } = run,
      total = (outcomes) => outcomes.reduce((n, o) => n + o.operations, 0),
      query = () => byId("work-chart").querySelector("title").textContent;
    const steps = [...work.ofStep.values()];
    equal(
      steps.reduce((n, o) => n + total(o), 0),
      total(work.work.outcomes),
      "the work of all steps is that of the run",
    );
    input("work-measure", "operations");
    const whole = query();
    input("work-scope", "step");
    for (const step of [0, steps.length - 1]) {
      timeline.toStep(step);
      await frame();
      check(
        query().includes(`${digits(total(steps[step]))} operation`),
        "the chart can show one step's",
        query(),
      );
    }
    input("work-scope", "run");
    equal(query(), whole, "and all again");
  }

  /** Rows of tables lead to regions and steps, and are marked where these are selected otherwise. */
  async function rowsLead() {
    const { selection, events } = run,
      rows = (what) => [...document.querySelectorAll(`tr.leads[data-to^="${what} "]`)],
      current = () => [...document.querySelectorAll("tr[aria-current]")];
    const [row, other] = rows("region 1");
    row.click();
    await frame();
    equal(selection.picked.side, 1, "a row of B's table selects a region of B");
    equal(digits(selection.picked.region), row.cells[0].textContent, "that which it is about");
    check(current().includes(row) && !current().includes(other), "and is marked");
    check(run.view.marks.shown.get("picked").parts.length > 0, "and the view shows the region");
    selection.pickRegion(1, Number(other.cells[0].textContent));
    check(current().includes(other) && !current().includes(row), "a region of the view marks its row");
    selection.pick(null);
    const last = rows("step").at(-1);
    last.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true, cancelable: true }));
    equal(digits(events.stepNumber(selection.event)), last.cells[0].textContent, "a row of a step leads to it");
    const [pair] = rows("pair");
    pair.click();
    await frame();
    const [step, a, b] = pair.dataset.to.split(" ").slice(1).map(Number);
    equal(events.stepNumber(selection.event), step, "a row of a contact region leads to its step");
    equal(selection.chosen.join(), `${a},${b}`, "and selects its first pair");
    check(byId("why-title").textContent.startsWith("Why"), "which is explained", byId("why-title").textContent);
    check(pair.hasAttribute("aria-current"), "and marks the row");
    const [boxes] = rows("boxes").slice(2);
    boxes.click();
    await frame();
    equal(run.view.now.boxes, 2, "a row of a depth shows its boxes");
    check(boxes.hasAttribute("aria-current") && byId("boxes").value === "2", "and is marked, and so is the list");
    run.controls.change({ boxes: -1 });
    press("Escape");
  }

  /** The window has no scroll bar, and neither has the header. */
  function fitsOneScreen() {
    const page = document.documentElement;
    check(page.scrollHeight <= innerHeight, `the page fits ${innerWidth} x ${innerHeight}`, page.scrollHeight);
    const box = (of) => of.getBoundingClientRect();
    for (const part of [byId("view-canvas"), document.querySelector(".timeline"), document.querySelector(".panel"), document.querySelector(".tab-body")]) {
      const { top, bottom, height } = box(part);
      check(top >= 0 && bottom <= innerHeight + 1 && height > 30, `${part.id || part.className} is in the window`, [top, bottom]);
    }
    check(box(byId("view-canvas")).height > 0.25 * innerHeight, "the view has a quarter of it", box(byId("view-canvas")).height);
    nothingIsCovered();
    const widest = run.tabs.names.find((name) => {
      run.tabs.show(name);
      return page.scrollHeight > innerHeight || page.scrollWidth > innerWidth;
    });
    equal(widest, undefined, "whichever tab is shown");
    run.tabs.show(run.tabs.names[0]);
  }

  /** No body is under the legend or the caption. */
  function nothingIsCovered() {
    const { view } = run,
      canvas = byId("view-canvas").getBoundingClientRect(),
      labels = ["legend", "view-caption"].map((name) => byId(name).getBoundingClientRect());
    const covered = view.extremes().filter((p) => {
      const at = p.project(view.camera.camera),
        x = canvas.left + (canvas.width * (1 + at.x)) / 2,
        y = canvas.top + (canvas.height * (1 - at.y)) / 2;
      return labels.some((l) => x > l.left && x < l.right && y > l.top && y < l.bottom);
    });
    equal(covered.length, 0, "no body is under the legend or the caption");
  }

  /** One thing is selected everywhere: view, panel, table of events, tables, charts, picture at the top. */
  async function selectsEverywhere() {
    const { events, selection, view, tabs } = run,
      test = events.kind.indexOf(events.CONTACT),
      face = events.faces(test)[0];
    selection.goTo(test);
    selection.pickFace(face.side, face.face);
    await frame();
    check(view.marks.shown.get("picked").parts.length > 0, "the view marks a selected face");
    check(byId("picked-title").textContent.includes(digits(face.face)), "the panel names it", byId("picked-title").textContent);
    check(byId("picked").getBoundingClientRect().top < byId("event-title").getBoundingClientRect().top, "before the event");
    tabs.show("Events");
    await frame();
    check(document.querySelector("#event-body .row.concerned"), "the table of events marks its events");
    check(moment.about.event.includes(events.id(test)), "and so do the charts", moment.about.event.length);
    check(moment.about.step.includes(events.stepNumber(test)), "over steps too");
    press("l");
    equal(tabs.shown, "Events", "l lists its events");
    check(run.table.rows.length < events.count, "and only these", run.table.rows.length);
    byId("filter-clear").click();
    press("Escape");
    equal(moment.about.event.length, 0, "Esc selects nothing, on charts as well");
    const bars = document.querySelectorAll(".strip .bar");
    equal(bars.length, events.firstOfStep.length, "the picture at the top has a bar for each step");
    bars[1].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    equal(events.step(selection.event), 1, "a click on one leads to its step");
    equal(Number(byId("step").value), 1, "and so does the slider");
    selection.pickRegion(0, events.bodies[0].regionCount - 1);
    const fitted = JSON.stringify(view.camera.json());
    press("i");
    await frame();
    const seen = view.ballOfFaces(view.collector(selection.picked));
    check(seen.radius / view.camera.halfHeight > 0.4, "an isolated region fills the view", seen.radius / view.camera.halfHeight);
    press("i");
    await frame();
    equal(JSON.stringify(view.camera.json()), fitted, "and then everything is seen as before");
    press("Escape");
    for (const cell of document.querySelectorAll(".tab td.n")) {
      const head = cell.closest("table").tHead.rows[0].cells[cell.cellIndex];
      if (head.title) continue;
      check(false, "every column of numbers says what it counts", head.textContent);
      break;
    }
    for (const tile of document.querySelectorAll(".numbers div")) check(tile.title, `${tile.textContent} has a tooltip`);
  }

  /** The address has the state, and another page of it shows the same. */
  async function keepsItsState() {
    const { events, selection, view, controls, tabs, address } = run,
      at = events.kind.indexOf(events.CONTACT) + 3;
    selection.goTo(at);
    selection.pickRegion(1, 0);
    press("3");
    equal(tabs.shown, tabs.names[2], "a digit shows a tab");
    controls.change({ ghost: true, boxes: 3, by: "tests", per: "region" });
    view.camera.turn(0.4, 0.1);
    await wait(400);
    const hash = location.hash,
      camera = view.camera.json().eye;
    for (const part of [`e${events.id(at)}`, "tab=", "pick=B.region.0", "camera=perspective", "ghost", "boxes:3", "by:tests", "per:region"])
      check(hash.includes(part), `the address has ${part}`, hash);
    selection.goTo(0);
    press("Escape");
    tabs.show(tabs.names[0]);
    controls.change({ ghost: false, boxes: -1, by: "kind", per: "face" });
    view.frameAll(view.camera.from);
    history.replaceState(null, "", hash);
    address.read();
    await frame();
    equal(selection.event, at, "which leads to its event");
    equal(`${selection.picked.side} ${selection.picked.region}`, "1 0", "its selection");
    equal(tabs.shown, tabs.names[2], "its tab");
    equal(`${view.now.ghost} ${view.now.boxes} ${view.now.by} ${view.now.per}`, "true 3 tests region", "its layers");
    const off = view.camera.json().eye.reduce((m, x, i) => Math.max(m, Math.abs(x - camera[i])), 0);
    check(off < 1e-4, "and its camera", off);
    controls.change({ ...view.opened });
    press("Escape");
    view.frameAll(view.camera.from);
    press("t");
    check(tabs.tall, "t makes tabs taller");
    press("t");
    await wait(400);
    lines.push(`hash ${hash}`);
  }

  /** Opened with an address that drive.js has made, the page shows that state. */
  async function opensAtItsAddress() {
    const { events, selection, view, tabs } = run,
      [, id] = /^#e(\d+)/.exec(location.hash);
    equal(events.id(selection.event), Number(id), "the page opens at the event of its address");
    equal(selection.picked && selection.picked.region, 0, "with the selection");
    equal(`${view.now.ghost} ${view.now.boxes} ${view.now.by}`, "true 3 tests", "the layers");
    equal(tabs.shown, tabs.names[2], "and the tab");
    check(!view.camera.fitted, "and the camera");
  }

  /** A page that has a part of the events takes all of them from the trace. */
  async function loadsTheTrace() {
    const { events, loader, selection } = run,
      names = ["kind", "side", "meet", "a", "b", "cause", "boundary", "work"],
      trace = JSON.parse(byId("trace-data").textContent);
    const whole = { count: events.count, stepNumbers: events.stepNumbers, firstOfStep: events.firstOfStep };
    for (const name of [...names, "depthA", "depthB", "outcome"]) whole[name] = events[name];
    const word = (i) => events.outcomes[events.outcome[i]] || "";
    const words = Array.from({ length: whole.count }, (_, i) => word(i)),
      kept = [...whole.kind.keys()].filter((i) => i % 3 === 0 || whole.kind[i] === events.STEP);
    const thin = { ids: Uint32Array.from(kept), count: kept.length, stepNumbers: whole.stepNumbers };
    for (const name of [...names, "depthA", "depthB", "outcome"])
      thin[name] = Uint32Array.from(kept, (i) => whole[name][i]);
    thin.firstOfStep = Uint32Array.from(whole.firstOfStep, (id) => kept.indexOf(id));
    events.replace(thin);
    run.table.refilter();
    const foreign = structuredClone(trace);
    foreign.metadata.bodies[0].hash = "0";
    for (const [wrong, what] of [
      [{}, "no trace"],
      [foreign, "the trace of other bodies"],
    ]) {
      let refused = "";
      try {
        loader.take(wrong);
      } catch (e) {
        refused = e.message;
      }
      check(refused !== "" && events.count === kept.length, `${what} is refused`, refused);
    }
    const poses = run.view.poses.map((p) => p.slice());
    await loader.open(new File([JSON.stringify(trace)], "trace.json"));
    equal(byId("load-state").textContent, "", "the trace is read");
    equal(events.count, whole.count, "all events are here");
    for (const name of names) {
      const sorts = { a: "a", b: "b" }[name];
      const differ = [...whole.kind.keys()].filter(
        (i) => events[name][i] !== whole[name][i] && (!sorts || events.kindOf(i)[sorts].words !== ""),
      );
      equal(differ.length, 0, `${name} of each is as the page had it`);
    }
    equal(words.findIndex((w, i) => w !== word(i)), -1, "and so are their results");
    const off = run.view.poses.map((p, side) =>
      p.reduce((m, x, i) => Math.max(m, Math.abs(x - poses[side][i % poses[side].length])), 0),
    );
    check(off.every((d) => d < 1e-5), "and so are poses", off);
    equal(run.table.rows.length, whole.count, "the table lists them");
    selection.goTo(events.count - 1);
    check(recordedSize([...whole.kind.keys()].filter((i) => events.changesWrapper(i)).at(-1)), "wrappers are replayed");
  }

  async function colours() {
    const most = run.events.bodies.reduce((m, b) => Math.max(m, ...b.counts.misses), 0);
    equal(
      run.events.bodies.reduce((n, b) => n + b.counts.tests.reduce((s, t) => s + t, 0), 0),
      2 * ofKind(run.events.FACE_TEST),
      "every test counts for a face of each body",
    );
    for (const by of ["layer", "region", "tests", "hits", "misses"]) {
      input("colour-by", by);
      await frame();
    }
    equal(byId("scale").hidden, false, "counters have a scale");
    equal(byId("scale-most").textContent, digits(most), "that goes to the most of both bodies");
    for (const body of run.events.bodies)
      for (const per of ["region", "level"]) {
        const sums = sumsOfGroups(body, per, body.counts.tests),
          seen = new Set();
        let total = 0;
        sums.forEach((n, f) => {
          const group = per === "region" ? body.regionOf(f) : body.depth(body.outer[f]);
          if (group !== NONE && seen.has(group)) return;
          seen.add(group);
          total += n;
        });
        equal(total, ofKind(run.events.FACE_TEST), `sums of ${per}s count every test once`);
      }
    input("colour-scope", "step");
    input("colour-per", "region");
    await frame();
    input("colour-per", "level");
    await frame();
    input("colour-by", "kind");
    await frame();
    equal(byId("scale").hidden, true, "and none without counters");
  }

  async function plays() {
    run.selection.goTo(run.timeline.firstHere);
    const before = run.selection.event;
    byId("play-speed").value = "30";
    press(" ");
    for (let k = 0; k < 40 && run.selection.event === before; k++) await wait(50);
    press(" ");
    check(run.selection.event > before, "space plays", run.selection.event);
    seek("event", run.events.id(run.events.count - 1));
    equal(run.selection.event, run.events.count - 1, "a chart leads to its event");
    show(0);
    equal(run.events.stepNumber(run.selection.event), data.frames[0].step, "a frame leads to its event");
  }

  /** A table of a million events, which the page's own repeat. */
  function largeTable() {
    const { events } = run,
      many = Object.create(events),
      count = 1e6;
    for (const name of ["kind", "side", "meet", "a", "b", "cause", "boundary", "depthA", "depthB"])
      many[name] = Uint32Array.from({ length: count }, (_, i) => events[name][i % events.count]);
    Object.assign(many, { count, ids: null });
    const { table } = run;
    run.tabs.show("Events");
    table.events = many;
    table.refilter();
    table.box.scrollTop = 1e9;
    table.box.dispatchEvent(new Event("scroll"));
    check(shownRows() < 60, "a table of a million events makes few rows", shownRows());
    equal(
      Number(document.querySelector("#event-body .row:last-child").dataset.event),
      count - 1,
      "and scrolls to its last",
    );
    input("filter-kind", events.REFINE);
    check(table.rows.length > 0 && table.rows.length < count, "and filters them");
    table.events = events;
    byId("filter-clear").click();
  }

  function fitsTheWidth() {
    equal(
      document.documentElement.scrollWidth,
      document.documentElement.clientWidth,
      `nothing sticks out of ${innerWidth} pixels`,
    );
  }

  async function withoutWebgl() {
    equal(run.view, null, "without WebGL there is no view");
    check(
      /WebGL/.test(byId("no-view").textContent) && !byId("no-view").hidden,
      "and the page says so",
      byId("no-view").textContent,
    );
    equal(
      byId("frames").open && byId("stage").contains(byId("frames")) && byId("frame").clientHeight > 100,
      true,
      "and shows frames in its place",
    );
    input("filter-kind", run.events.REFINE);
    equal(run.table.rows.length, ofKind(run.events.REFINE), "the table works as before");
    const before = run.selection.event;
    press("ArrowRight");
    equal(run.selection.event, before + 1, "and so do keys");
  }

  function opensAtTheBody() {
    const { events, selection, wrappers } = run;
    equal(events.kind[selection.event], events.STEP, "a construction opens at its first event");
    equal(wrappers.sizes[0], events.bodies[0].realCount, "where the hull has the body's faces");
    const words = byId("help").textContent + document.body.innerText;
    check(!/refine/i.test(words), "and the page has no word of refinement", /.{20}refine.{20}/i.exec(words));
  }

  async function buildsPassByPass() {
    const { events, selection, wrappers, timeline, view } = run;
    byId("play-what").value = "pass";
    let passes = 0,
      rejections = 0;
    for (let next = timeline.next(); next; next = timeline.next()) {
      next();
      if (events.kind[selection.event] !== events.PASS_END) continue;
      passes++;
      if (!recordedSize(selection.event)) check(false, "the hull after a pass", wrappers.sizes);
      await frame();
      rejections += /rejected: \d+ /.test(byId("view-caption").textContent);
      const made = events.builtIn(selection.event).length;
      const marked = view.marks.shown.get("refined").parts.length > 0;
      if (marked !== made > 0) check(false, "new lids are pointed out after a pass", `${made} regions`);
    }
    equal(passes, events.passes.length, "passes can be played one by one");
    const layers = [...events.bodies[0].layer],
      newest = Math.max(...layers),
      lidOf = (layer) => events.bodies[0].lids(layers.indexOf(layer))[0],
      pale = view.colours.mode(events.bodies, "region", null, newest),
      full = view.colours.mode(events.bodies, "region", null);
    check(newest > 0, "there are several layers", newest);
    check(pale.of(0, lidOf(0)).every((c, i) => c >= full.of(0, lidOf(0))[i]), "early lids are paled");
    check(`${pale.of(0, lidOf(0))}` !== `${full.of(0, lidOf(0))}`, "visibly");
    equal(`${pale.of(0, lidOf(newest))}`, `${full.of(0, lidOf(newest))}`, "and new ones are not");
    equal(wrappers.sizes[0], wrappers.outermost[0], "to the outermost wrapper");
    check(rejections > 3, "and say why caps were rejected", rejections);
  }

  /** The page of another engine's run has no word of what only lrbscope has, in texts or tooltips. */
  async function namesOnlyItsOwn() {
    const { events, selection, view } = run,
      strange = /.{0,30}(wrapper|pseudo|refine|\blids?\b|real face|\blayers?\b|\bplanes? of faces|region).{0,30}/i,
      found = new Set();
    const look = () => {
      for (const part of document.querySelectorAll("body *")) {
        if (["SCRIPT", "STYLE"].includes(part.tagName) || part.closest(".of-regions[hidden], [data-tab=Contacts]")) continue;
        const own = [...part.childNodes].filter((n) => n.nodeType === Node.TEXT_NODE).map((n) => n.data);
        for (const text of [...own, part.title || "", part.getAttribute("aria-label") || ""]) {
          const word = strange.exec(text.replace(/contact regions?/gi, ""));
          if (word) found.add(word[0].trim());
        }
      }
    };
    check(events.engine, "another engine was recorded");
    check([...document.querySelectorAll(".tab-panel")].every((tab) => tab.textContent.trim()), "no tab is empty");
    look();
    selection.goTo(events.kind.indexOf(events.CONTACT));
    selection.pickFace(0, events.faces(selection.event)[0].face);
    await frame();
    look();
    for (const by of ["tests", "kind"]) {
      input("colour-by", by);
      await frame();
      look();
    }
    equal([...found].join(" | "), "", "no word of wrappers, regions and their faces");
    check(view && !view.now.lids, "and none is drawn");
  }

  /** The attempts at a vertex, a face and a region, as the trace has them; by clicks, keys and the address. */
  async function listsAttempts() {
    const { events, selection, view, address, table } = run,
      slices = JSON.parse(byId("trace-data").textContent).traceEvents.filter((e) => e.ph === "X" && e.args.event !== undefined),
      patches = new Map(slices.filter((e) => e.name === "patch").map((e) => [e.args.event, e.args])),
      caps = slices.filter((e) => e.name === "cap").map((e) => e.args),
      rows = () => [...byId("attempt-rows").children],
      capsAt = (v) => caps.filter((c) => (patches.get(c.cause).vertices || []).includes(v)),
      shown = () => rows().map((r) => events.id(r.attempt.cap)).join(" ");
    check([...patches.values()].every((p) => !p.vertices || p.vertices.length === p["interior vertices"]), "the trace has the vertices of patches");
    const busiest = [...Array(events.bodies[0].vertices.length / 3).keys()].reduce((p, q) => (capsAt(q).length > capsAt(p).length ? q : p));
    check(capsAt(busiest).length > 2, "several caps were tried at one vertex", capsAt(busiest).length);
    selection.pickVertex(0, busiest);
    equal(shown(), capsAt(busiest).map((c) => c.event).join(" "), "the panel lists the attempts at a vertex, in order");
    const words = rows().map((r) => r.cells[3].textContent);
    const named = (verdict) => (verdict === "stands" ? "accepted" : verdict);
    check(capsAt(busiest).every((c, i) => words[i].startsWith(named(c.verdict)) && words[i].length > c.verdict.length + 12), "with the reasons in words", words.join("; "));
    // A rejected attempt: the patch on the front, which stays as it is.
    const rejected = capsAt(busiest).findIndex((c) => c.verdict !== "stands");
    rows()[rejected].click();
    await frame();
    equal(events.id(selection.event), capsAt(busiest)[rejected].event, "a click on a row goes to its cap");
    const patch = patches.get(capsAt(busiest)[rejected].cause);
    equal(view.attemptFaces(events.attempts.ofEvent.get(selection.event)).length, patch.faces, "the view shows the patch with all its faces");
    check(view.marks.shown.get("start") && view.marks.shown.get("vertex") && view.marks.shown.get("attempt").parts.length, "with its start vertex and the selected one");
    check(byId("attempt-after").disabled && byId("attempt-kept").textContent, "and says that the front stays as it is");
    equal(rows()[rejected].getAttribute("aria-current"), "true", "the row is marked");
    // An accepted one: before and after.
    const region = events.bodies[0].regionCount >> 1,
      made = slices.find((e) => e.name === "region" && e.args.region === region).args;
    selection.pickRegion(0, region);
    check(shown().split(" ").includes(String(made.cause)), "a region lists the attempt that made it", shown());
    events.attempts.coveredBy(region).forEach((v) => {
      const missing = capsAt(v).filter((c) => !shown().split(" ").includes(String(c.event)));
      if (missing.length) check(false, "and all those at the vertices that it covers", missing.length);
    });
    rows().find((r) => events.id(r.attempt.cap) === made.cause).click();
    await frame();
    equal(events.id(selection.event) >= made.event, true, "an accepted attempt is shown with its regions");
    const after = run.wrappers.sizes[0];
    press("b");
    await frame();
    check(run.wrappers.sizes[0] > after, "B shows the front before it", `${run.wrappers.sizes[0]} ${after}`);
    equal(view.attemptFaces(events.attempts.ofEvent.get(selection.event)).length, patches.get(caps.find((c) => c.event === made.cause).cause).faces, "with its patch");
    press("b");
    equal(run.wrappers.sizes[0], after, "and again the front after it");
    press("h", true);
    check(rows().length < 2 || events.id(selection.event) < made.cause, "H goes to the attempt before", events.id(selection.event));
    // The place of an event, by key; of a row of the table, by a click.
    selection.goTo(events.find(caps[0].event));
    press("p");
    equal(selection.picked.vertex, patches.get(caps[0].cause).vertex, "P selects the start vertex of the event");
    table.body.querySelector("[aria-selected=true]").click();
    equal(selection.picked.vertex, patches.get(caps[0].cause).vertex, "as does a click on the event's row");
    equal(/pick=A\.vertex\.\d+/.exec(address.text())[0], `pick=A.vertex.${selection.picked.vertex}`, "the address has the vertex");
    selection.pick(null);
    location.hash = `#e0&pick=A.vertex.${busiest}`;
    address.read();
    equal(selection.picked && selection.picked.vertex, busiest, "and leads to it");
    press("l");
    equal(table.rows.length, events.attempts.eventsAt(selection.picked).size, "L lists the events there");
    run.form.clear();
    // A click on a corner of a face selects the vertex; in the middle of it, the face.
    selection.goTo(0);
    view.frameAll();
    await frame();
    const box = view.canvas.getBoundingClientRect(),
      [body] = events.bodies,
      at = (points) => {
        const p = points.map((v) => view.views[0].toWorld(view.views[0].point(v)).project(view.camera.camera));
        return [0, 1].map((k) => p.reduce((s, q) => s + q.getComponent(k), 0) / p.length).map((c, k) => (k ? box.top + ((1 - c) / 2) * box.height : box.left + ((1 + c) / 2) * box.width));
      };
    const centroid = view.reach().centre.project(view.camera.camera),
      [x, y] = [box.left + ((1 + centroid.x) * box.width) / 2, box.top + ((1 - centroid.y) * box.height) / 2],
      face = view.picker.under(x, y).face,
      clickAt = ([cx, cy]) => {
        for (const type of ["pointerdown", "pointerup", "click"]) view.canvas.dispatchEvent(new PointerEvent(type, { clientX: cx, clientY: cy, bubbles: true, button: 0 }));
      };
    clickAt(at([...body.face(face)]));
    equal(selection.picked && selection.picked.face, face, "a click in a face selects it");
    const corner = body.face(face)[0],
      inside = at([corner, corner, corner, corner, corner, corner, corner, corner, corner, ...body.face(face)]);
    clickAt(inside);
    equal(selection.picked && selection.picked.vertex, corner, "a click next to its corner, the vertex");
  }

  /** The fill of A alone has as many pixels as its loops have inside. */
  function fillsInside(view, camera) {
    const [a] = view.views,
      { fan, sheet } = a.fills.solid,
      others = [...view.stage.children, ...a.group.children].filter(
        (o) => ![a.group, fan, sheet].includes(o) && !o.isCamera && !o.isLight,
      ),
      were = others.map((o) => o.visible),
      gl = view.renderer.getContext(),
      { width, height } = view.canvas,
      pixels = new Uint8Array(4 * width * height);
    for (const o of others) o.visible = false;
    view.renderer.render(view.stage, camera);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    others.forEach((o, i) => (o.visible = were[i]));
    let inside = 0,
      area = 0;
    for (let i = 3; i < pixels.length; i += 4) inside += pixels[i] > 0;
    for (let face = 0; face < a.body.realCount; face++) {
      const [p, q] = [...a.body.face(face)].map((v) => {
        const at = a.toWorld(a.point(v)).project(camera);
        return [(at.x * width) / 2, (at.y * height) / 2];
      });
      area += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    check(
      Math.abs(inside / Math.abs(area) - 1) < 0.05,
      "a flat body is filled, inside and nowhere else",
      `${inside} pixels for ${area}`,
    );
  }

  /** Bodies of the plane are seen from above, and cannot be turned. */
  async function liesFlat() {
    const { view, events, selection } = run,
      { camera } = view;
    check(view && camera.orthographic, "flat bodies have a view, seen along parallels");
    for (const id of ["orthographic", "copy-camera"]) equal(byId(id), null, `without ${id}`);
    view.frameAll();
    await frame();
    const before = camera.camera.position.toArray().join();
    for (const key of ["a", "e", "o"]) press(key);
    await frame();
    equal(camera.camera.position.toArray().join(), before, "that keys do not turn");
    const way = camera.camera.position.clone().sub(camera.controls.target).normalize();
    check(way.z > 0.999, "from above", way.toArray());
    run.timeline.toStep(events.firstOfStep.length - 1);
    await frame();
    check(view.views.every((v) => v.real.mesh.geometry.boundingSphere.radius > 0), "their segments are drawn");
    const body = events.bodies[0],
      [p, q] = body.face(0),
      midpoint = [0, 1, 2].map((i) => (body.vertices[3 * p + i] + body.vertices[3 * q + i]) / 2),
      at = view.views[0].toWorld(midpoint).project(camera.camera),
      box = byId("view-canvas").getBoundingClientRect();
    const hit = view.picker.under(
      box.left + ((1 + at.x) / 2) * box.width,
      box.top + ((1 - at.y) / 2) * box.height,
      true,
    );
    check(hit && hit.side === 0 && hit.face === 0, "a click finds the segment under it", JSON.stringify(hit));
    fillsInside(view, camera.camera);
    const zoom = camera.flat.zoom;
    press("+");
    await frame();
    check(camera.flat.zoom > zoom, "keys zoom");
    selection.pickRegion(0, 0);
    press("i");
    await frame();
    check(view.views[0].pieces.some((piece) => piece.triangles > 0), "a region can be isolated");
    press("i");
  }

  /** A body without regions is never called a wrapper. */
  async function showsTheOpenBody() {
    const { events, selection } = run;
    selection.goTo(events.kind.indexOf(events.STEP));
    await frame();
    const says = (id, words) =>
      check(byId(id).textContent.includes(words), `${id} says "${words}"`, byId(id).textContent);
    says("view-caption", "A (it has no wrapper) and B's outermost wrapper");
    says("view-caption", "Wrappers: A 5 (no wrapper) + B ");
    says("event-facts", "A 5 (no wrapper) + B ");
    says("legend", "A open, real faces");
    says("legend", "B rock, pseudo faces");
    check(!byId("legend").textContent.includes("A open, pseudo faces"), "the legend has no pseudo faces of A");
    const numbers = document.querySelector(".numbers").textContent;
    check(numbers.includes("A is open; no regions"), "the page says why", numbers);
  }

  /** The view begins as the scenario's first one looks, with its axis up, and turns about that. */
  async function looksAsFramesDo() {
    const { camera } = run.view,
      way = () => camera.camera.position.clone().sub(camera.controls.target).normalize();
    run.view.frameAll(camera.from);
    await frame();
    check(way().distanceTo(new THREE.Vector3(0.5, 0.6, 0.6).normalize()) < 1e-6, "looks from where frames do", way().toArray());
    const height = way().y;
    camera.turn(0.7, 0);
    check(Math.abs(way().y - height) < 1e-6, "turns about the axis that is up", way().toArray());
    equal(JSON.stringify(camera.json().up), "[0,1,0]", "a copied camera says which");
  }

  /** How near, and how deep: a line or an arrow in every step that has one, with its length in words. */
  async function measures() {
    const { events, selection, view, scene } = run,
      label = byId("measured"),
      steps = JSON.parse(byId("trace-data").textContent).metadata.steps,
      texts = new Set();
    check(scene.measured !== null, "the page has what was measured");
    for (const [step, { result }] of steps.entries()) {
      selection.goTo(events.firstOfStep[step]);
      await frame();
      const apart = result.distance.lower > 0,
        deep = result.clash.depth && result.clash.depth[1] > 0;
      equal(view.measured.group.children.length, apart || deep ? 2 : 0, `step ${step} has its way`);
      equal(label.hidden, !(apart || deep), "and its length");
      if (!apart && !deep) continue;
      const shown = view.measured.shown,
        length = shown.to.distanceTo(shown.from) * scene.unit,
        wanted = apart ? result.distance.upper : result.clash.depth[1];
      check(Math.abs(length - wanted) < 1e-5 * scene.unit, "as long as the trace says", `${length}, not ${wanted}`);
      check(label.textContent.startsWith(apart ? "distance " : "depth "), "in words", label.textContent);
      check(byId("legend").textContent.includes(apart ? "nearest points" : "B leaves A"), "and in the key", byId("legend").textContent);
      texts.add(label.textContent);
    }
    check([...texts].some((t) => t.startsWith("distance ")) && [...texts].some((t) => t.startsWith("depth ")), "the run comes near and goes in", [...texts]);
  }

  const parts = {
    measured: [measures, fitsTheWidth],
    open: [opensAtFirstContact, showsTheOpenBody, looksAsFramesDo, fitsTheWidth],
    plane: [opensAtFirstContact, replaysAsRecorded, liesFlat, fitsTheWidth],
    build: [opensAtTheBody, nothingIsCovered, replaysAsRecorded, buildsPassByPass, listsAttempts, fitsTheWidth],
    engine: [namesOnlyItsOwn, nothingIsCovered, fitsTheWidth],
    reload: [opensAtItsAddress],
    screen: [fitsOneScreen],
    all: [
      opensAtFirstContact,
      replaysAsRecorded,
      slides,
      clicks,
      filters,
      presses,
      walks,
      explains,
      shares,
      sharesOfSteps,
      rowsLead,
      selectsEverywhere,
      keepsItsState,
      colours,
      plays,
      largeTable,
      loadsTheTrace,
      fitsTheWidth,
    ],
    layout: [fitsTheWidth],
    flat: [opensAtFirstContact, withoutWebgl],
  };
  for (const part of parts[new URLSearchParams(location.search).get("drive")]) {
    try {
      await frame();
      await part();
    } catch (e) {
      check(false, part.name, e.stack || e);
    }
  }
  check(complaints.length === 0, "the console is empty", complaints.join("; "));
  const out = document.createElement("pre");
  out.id = "driven";
  out.textContent = [...lines, "done"].join("\n");
  if (parent === window) document.body.append(out);
  else parent.postMessage(out.textContent, "*");
})();
