// Operates a run's page, and prints "ok ..." or "FAIL ..." for each check, then "done": the page against the
// trace, and one way of each kind (slider, click, key, table, address) to select something.
(function () {
  const { check, equal, press, lines } = driven,
    { run } = scene_js,
    { byId, digits } = dom_js,
    { data, moment } = page_js,
    { lastAtMost } = scene_run_js,
    { events, selection, view, wrappers, table, tabs, timeline, why } = run;
  const wait = (ms) => new Promise((then) => setTimeout(then, ms)),
    text = (id) => byId(id).textContent,
    trace = () => JSON.parse(text("trace-data"));
  // Time is virtual here and does not wait for pictures: the script requests them.
  const frame = async () => {
    await wait(20);
    if (view) view.draw();
  };
  const input = (id, value) => {
    byId(id).value = value;
    byId(id).dispatchEvent(new Event("input", { bubbles: true }));
  };
  const clickAt = (x, y) => {
    for (const type of ["pointerdown", "pointerup", "click"])
      view.canvas.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, bubbles: true, button: 0 }));
  };
  /** Returns where a point of the world is on the screen. */
  const screenOf = (point) => {
    const box = view.canvas.getBoundingClientRect(),
      at = point.clone().project(view.camera.camera);
    return [box.left + (box.width * (1 + at.x)) / 2, box.top + (box.height * (1 - at.y)) / 2];
  };
  const indices = () => [...events.kind.keys()];
  const ofKind = (kind) => indices().filter((i) => events.kind[i] === kind).length;
  const recordedSize = (i) => wrappers.sizes[events.side[i]] === events.boundary[i];
  const firstContact = () => events.kind.indexOf(events.CONTACT);

  /** The page opens in the step with most pairs, at its last contact. */
  function opensAtLargestContact() {
    const { steps } = trace().metadata,
      most = Math.max(...steps.map(({ result }) => result.pairs)),
      step = steps.find(({ result }) => result.pairs === most).index;
    equal(events.stepNumber(selection.event), step, "opens in the step with most pairs");
    const later = indices().filter(
        (i) => i > selection.event && events.kind[i] === events.CONTACT && events.stepNumber(i) === step);
    equal(`${events.kind[selection.event]} ${later}`, `${events.CONTACT} `, "at its last contact");
    check(text("view-caption").includes("contact"), "the caption says so", text("view-caption"));
    const shown = data.frames[parseInt(text("count")) - 1];
    equal(shown.step, events.stepNumber(selection.event), "frames stand at the same step");
  }

  /** Badge, figures and curves are those of the step of the slider. */
  async function showsOneStep() {
    const badge = document.querySelector(".verdict"),
      numbers = document.querySelector("header .numbers");
    for (const [at, { index, result }] of trace().metadata.steps.entries()) {
      timeline.toStep(at);
      await frame();
      equal(badge.textContent, result.relation.replaceAll("_", " "), `the badge of step ${index}`);
      const shown = [...numbers.children].map((n) => n.textContent).slice(0, 2).join();
      equal(shown, `Step${digits(index)},Pairs${digits(result.pairs)}`, "and its figures");
      equal(view.curves.now.length > 0, result.pairs > 0, "a step with pairs has contact curves");
      equal(text("legend").includes("contact"), result.pairs > 0, "which the legend names");
    }
    selection.goTo(firstContact());
  }

  function replaysAsRecorded() {
    const changes = indices().filter((i) => events.changesWrapper(i));
    check(changes.length > 20, "wrappers change", changes.length);
    for (const order of [changes, changes.slice().reverse()]) {
      const wrong = order.filter((i) => (wrappers.seek(i), !recordedSize(i)));
      equal(wrong.length, 0, "wrappers have as many faces as recorded, forward and backward");
    }
    selection.goTo(selection.event);
  }

  /** Sliders, the table of events, charts, the picture at the top and keys lead to the same selection. */
  async function selectsEverywhere() {
    const changes = [...Array(timeline.lastHere - timeline.firstHere).keys()],
      change = changes.reverse().find((i) => events.changesWrapper(timeline.firstHere + i));
    input("event", change);
    await frame();
    equal(selection.event, timeline.firstHere + change, "the slider moves to its event");
    const faces = digits(events.boundary[selection.event]);
    check(text("event-facts").includes(faces), "the panel says how many faces");
    document.querySelectorAll(".strip .bar")[1].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    equal(events.step(selection.event), 1, "a click on a bar leads to its step");
    equal(Number(byId("step").value), 1, "and so does the slider");
    const here = selection.event;
    press("ArrowRight");
    equal(selection.event, here + 1, "an arrow key moves by one event");
    selection.goTo(firstContact());
    const [face] = events.faces(selection.event);
    selection.pickFace(face.side, face.face);
    tabs.show("Events");
    await frame();
    check(view.marks.shown.get("picked").parts.length > 0, "the view marks a selected face");
    check(text("picked-title").includes(digits(face.face)), "the panel names it", text("picked-title"));
    check(document.querySelector("#event-body .row.concerned"), "the table marks its events");
    check(moment.about.event.includes(events.id(firstContact())), "and so do the charts");
    press("l");
    check(table.rows.length < events.count, "l lists its events alone");
    byId("filter-clear").click();
    press("Escape");
    equal(moment.about.event.length, 0, "Esc selects nothing");
    selection.pickRegion(0, events.bodies[0].regionCount - 1);
    press("i");
    await frame();
    check(view.views[0].pieces.some((p) => p.triangles > 0), "i isolates the selected region");
    press("i");
    press("Escape");
    const before = selection.event;
    press(" ");
    for (let k = 0; k < 40 && selection.event === before; k++) await wait(50);
    press(" ");
    check(selection.event > before, "space plays", selection.event);
    press("v");
    await frame();
    lines.push(`camera ${text("camera-json")}`);
  }

  async function clicks() {
    timeline.toStep(events.firstOfStep.length - 1);
    view.frameAll();
    await frame();
    const box = view.canvas.getBoundingClientRect();
    const isPseudo = (hit) => hit && !events.bodies[hit.side].isReal(hit.face);
    let at = null;
    for (let x = 0.1; x < 1 && !at; x += 0.05)
      for (let y = 0.1; y < 1 && !at; y += 0.1) {
        const point = [box.left + x * box.width, box.top + y * box.height].map(Math.round);
        if (isPseudo(view.picker.under(...point))) at = point;
      }
    if (!at) return check(false, "a pseudo face can be seen");
    clickAt(...at);
    check(/^Pseudo face/.test(text("picked-title")), "a click on it fills the panel", text("picked-title"));
    for (const word of ["layer", "lids", "floor", "tests", "hits", "misses"])
      check(text("picked-facts").includes(word), `with ${word}`);
    const { side, goal } = selection.picked, sizes = wrappers.sizes.join();
    press("m");
    view.draw();
    check(wrappers.onBoundary(side, goal), "m refines the wrapper down to the face under it");
    check(view.marks.shown.get("resolved").parts.length > 0, "shows the faces on the way");
    check(text("picked-facts").includes("way in"), "and lists them");
    check(text("view-caption").includes(digits(wrappers.sizes[side])), "the caption has its faces");
    byId("picked-facts").querySelector("button").click();
    check(!selection.picked.goal && wrappers.onBoundary(side, goal), "also if a region is selected");
    press("Escape");
    equal(wrappers.sizes.join(), sizes, "Esc undoes it");
    view.draw();
    const {array} = view.glass.mesh.geometry.attributes.position,
          ahead = view.camera.camera.getWorldDirection(new THREE.Vector3()),
          far = (i) => ahead.dot(new THREE.Vector3(...array.subarray(i, i + 3))),
          depths =
              Array.from({length: array.length / 9}, (_, t) => far(9 * t) + far(9 * t + 3) + far(9 * t + 6));
    check(depths.length > 0 && depths.every((d, t) => t === 0 || d <= depths[t - 1] + 1e-3),
        "lids of both bodies are drawn from back to front");
    const depth = () => view.nearest(...at, view.views.flatMap((v) => [v.lids, v.real])), front = depth();
    view.look({ slice: 1 });
    view.draw();
    equal(depth(), null, "sliced away, nothing is under the pointer");
    view.look({ slice: 0 });
    view.draw();
    equal(depth().face, front.face, "and then again what was");
  }

  /** The filters of the table, also of a million events, which the page's own repeat. */
  function filters() {
    const rowsMade = () => document.querySelectorAll("#event-body .row").length;
    tabs.show("Events");
    equal(table.rows.length, events.count, "all events are listed");
    input("filter-kind", events.REFINE);
    equal(table.rows.length, ofKind(events.REFINE), "the filter of kinds leaves the refinements");
    input("filter-pair", "x");
    equal(byId("filter-pair").getAttribute("aria-invalid"), "true", "nonsense is marked");
    byId("filter-clear").click();
    document.querySelectorAll("#event-body .row")[2].click();
    equal(selection.event, table.rows[table.first + 2], "a click on a row selects its event");
    const many = Object.create(events),
      count = 1e6;
    for (const name of ["kind", "side", "meet", "a", "b", "cause", "boundary", "depthA", "depthB"])
      many[name] = Uint32Array.from({ length: count }, (_, i) => events[name][i % events.count]);
    table.events = Object.assign(many, { count, ids: null });
    table.refilter();
    table.box.scrollTop = 1e9;
    table.box.dispatchEvent(new Event("scroll"));
    check(rowsMade() > 3 && rowsMade() < 60, "a table of a million events makes few rows", rowsMade());
    const last = document.querySelector("#event-body .row:last-child");
    equal(Number(last.dataset.event), count - 1, "and scrolls to its last");
    table.events = events;
    byId("filter-clear").click();
  }

  /** The button of wrong pairs moves from one to the next. */
  function showsWrongPairs() {
    const { wrong } = events, pairs = [[0, 0], [1, 1]].map((simplices) => ({ simplices, missed: true }));
    events.wrong = wrong.map(() => pairs);
    selection.goTo(selection.event);
    const button = byId("event-facts").lastElementChild.firstChild,
      next = () => (button.click(), `${button.isConnected} ${button.textContent} ${selection.chosen}`);
    equal(next(), "true 1 of 2: missed 0,0", "the button of wrong pairs selects the first");
    equal(next(), "true 2 of 2: missed 1,1", "and then the second");
    Object.assign(events, { wrong });
    selection.goTo(selection.event);
  }

  /** Why: of a contact, and of a step in which the bodies are apart. */
  async function explains() {
    const contact = firstContact();
    selection.goTo(contact);
    await frame();
    check(/The faces (cross|touch)\. Decided by /.test(text("why")), "a contact is explained", text("why"));
    const [root] = byId("why-way").querySelectorAll("tr");
    check(root.textContent.startsWith("0, 0"), "the way begins at the roots", root.textContent);
    root.querySelector("button").click();
    await frame();
    equal(view.marks.shown.get("way").parts.length, 2, "a click on a row shows its boxes");
    root.querySelector("button").click();
    const [a, b] = events.faces(contact).map((f, side) => events.bodies[side].firstSimplex[f.face]),
      command = text("why-command").split(" --run ")[1].split(" ").slice(1).join(" ");
    const wanted = `--step ${events.stepNumber(contact)} --pair ${a},${b}`;
    equal(command, wanted, "the command names step and pair");
    lines.push(`command ${text("why-command")}`, `verdict ${text("why-verdict")}`);
    const [apart] = why.explanations.steps.keys();
    selection.goTo(events.endOfStep(lastAtMost(events.stepNumbers, apart)) - 1);
    await frame();
    const isExplained = /What separates the bodies.*Apart/s.test(text("why"));
    check(isExplained, "and so is a step without contact", text("why"));
    check(view.whyMarks.group.children.length > 0, "also in the view");
  }

  /**
   * The proof map fills with the events: in the end every pair is decided, and contacts are those of the
   * step.
   */
  async function mapsAllPairs() {
    const { map } = run,
      step = events.step(firstContact()),
      first = events.firstOfStep[step],
      last = events.endOfStep(step) - 1;
    const undecided = async (event) => {
      selection.goTo(event);
      await frame();
      map.draw();
      return map.cells.pairs - map.counted.sums.subarray(0, 9).reduce((n, x) => n + x, 0);
    };
    tabs.show("Proof map");
    equal(
        await undecided(first), run.scene.bodies.reduce((n, b) => n * b.realFaces, 1),
        "at first the map is one undecided square");
    const halfway = await undecided((first + last) >> 1);
    check(halfway > 0 && halfway < map.cells.pairs / 2, "it fills", halfway);
    equal(await undecided(last), 0, "in the end each pair is decided");
    const inStep =
        indices().filter((i) => events.kind[i] === events.CONTACT && events.step(i) === step).length;
    equal(map.counted.sums[7], inStep, "it has the contacts of the step");
    map.point([0.5, 0.5]);
    check(map.text(map.pointed).startsWith("Event "), "and says what decided a place", map.text(map.pointed));
    map.go([0.5, 0.5]);
    equal(events.id(selection.event), map.cells.event[map.pointed], "a click goes there");
    map.approach(0.5);
    map.draw();
    equal(map.deep.value, "50", "the slider is where it leads to this part");
    map.box.querySelector("button").click();
    map.draw();
    equal(map.deep.value, "0", "also at the whole");
  }

  /** A row of a table of each kind selects what it is about, and is marked. */
  async function rowsLead() {
    const rowOf = (what) => document.querySelectorAll(`tr.leads[data-to^="${what} "]`)[0];
    const follow = async (what) => {
      rowOf(what).click();
      await frame();
      check(rowOf(what).hasAttribute("aria-current"), `a row of a ${what} is marked`);
      return rowOf(what).dataset.to.split(" ").slice(1).map(Number);
    };
    const [side, region] = await follow("region");
    const { picked } = selection;
    equal(`${picked.side} ${picked.region}`, `${side} ${region}`, "and selects the region");
    press("Escape");
    const [number] = await follow("step");
    equal(events.stepNumber(selection.event), number, "and leads to the step");
    const [step, a, b] = await follow("pair");
    const chosen = selection.chosen.join();
    equal(`${events.stepNumber(selection.event)} ${chosen}`, `${step} ${a},${b}`, "and to the pair");
    const [depth] = await follow("boxes");
    equal(view.now.boxes, depth, "and shows the boxes of the depth");
    run.controls.change({ boxes: -1 });
    press("Escape");
    const untitled = [...document.querySelectorAll(".tab td.n")]
      .map((cell) => cell.closest("table").tHead?.rows[0].cells[cell.cellIndex])
      .find((head) => head && !head.title);
    check(!untitled, "every column of numbers says what it counts", untitled && untitled.textContent);
  }

  /** The address has the state; another page of it shows the same (opensAtItsAddress). */
  async function keepsItsState() {
    selection.goTo(firstContact() + 3);
    selection.pickRegion(1, 0);
    tabs.show(tabs.names[2]);
    run.controls.change({ ghost: true, boxes: 3, by: "tests", per: "region" });
    view.camera.turn(0.4, 0.1);
    await wait(400);
    const parts = ["pick=B.region.0", "tab=", "camera=perspective", "ghost", "boxes:3", "by:tests"];
    for (const part of parts) check(location.hash.includes(part), `the address has ${part}`, location.hash);
    lines.push(`hash ${location.hash}`);
  }

  function opensAtItsAddress() {
    const [, id] = /^#e(\d+)/.exec(location.hash);
    equal(events.id(selection.event), Number(id), "the page opens at the event of its address");
    equal(selection.picked && selection.picked.region, 0, "with the selection");
    equal(`${view.now.ghost} ${view.now.boxes} ${view.now.by}`, "true 3 tests", "the layers");
    equal(tabs.shown, tabs.names[2], "and the tab");
    check(!view.camera.fitted, "and the camera");
  }

  /** A page that has a part of the events takes all of them from the trace. */
  async function loadsTheTrace() {
    const stored = ["kind", "side", "meet", "a", "b", "cause", "boundary", "work"],
      names = [...stored, "depthA", "depthB", "outcome"];
    const whole = Object.fromEntries(names.map((name) => [name, events[name]])),
      { count, firstOfStep: [, ...later] } = events, // the first step is not on the page
      kept = indices().filter((i) => i >= later[0] && (i % 3 === 0 || events.kind[i] === events.STEP)),
      firstOfStep = Uint32Array.from(later, (id) => kept.indexOf(id)),
      stepNumbers = events.stepNumbers.slice(1);
    const thin = { ids: Uint32Array.from(kept), count: kept.length, stepNumbers, firstOfStep };
    for (const name of names) thin[name] = Uint32Array.from(kept, (i) => whole[name][i]);
    events.replace(thin);
    table.refilter();
    tabs.show("Proof map");
    selection.goTo(kept.length - 1);
    await frame();
    run.map.draw();
    check(run.map.cells.event[0] >= later.at(-1), "the map is that of the step with this number");
    const foreign = trace();
    foreign.metadata.bodies[0].hash = "0";
    for (const wrong of [{}, foreign]) {
      let refused = "";
      try {
        run.loader.take(wrong);
      } catch (e) {
        refused = e.message;
      }
      check(refused !== "" && events.count === kept.length, "another trace is refused", refused);
    }
    await run.loader.open(new File([text("trace-data")], "trace.json"));
    equal(text("load-state"), "", "the trace is read");
    equal(events.count, count, "all events are here");
    for (const name of stored) {
      const hasNumber = (i) => !["a", "b"].includes(name) || events.kindOf(i)[name].words !== "";
      const differ = indices().filter((i) => events[name][i] !== whole[name][i] && hasNumber(i));
      equal(differ.length, 0, `${name} of each is as the page had it`);
    }
    equal(table.rows.length, count, "the table lists them");
  }

  /** The window has no scroll bar; tabs are closed until used. */
  function fitsOneScreen() {
    const page = document.documentElement;
    equal(tabs.shown, "", "no tab is open");
    const closed = view.canvas.clientHeight;
    for (const name of tabs.names) {
      tabs.show(name);
      check(page.scrollHeight <= innerHeight, `it fits ${innerWidth} x ${innerHeight}`, page.scrollHeight);
      check(page.scrollWidth <= innerWidth, "and its width", page.scrollWidth);
      check(view.canvas.clientHeight > 0.25 * innerHeight, "beside a tab the view has a quarter of it");
    }
    for (const key of "11") press(key); // opens the first, and closes it
    equal(
        `${tabs.shown} ${view.canvas.clientHeight}`, ` ${closed}`,
        "the tab's key closes it, and the view has the room");
  }

  function withoutWebgl() {
    equal(view, null, "without WebGL there is no view");
    check(/WebGL/.test(text("no-view")) && !byId("no-view").hidden, "and the page says so", text("no-view"));
    check(byId("frames").open && byId("frame").clientHeight > 100, "and shows frames in its place");
    const before = selection.event;
    press("ArrowRight");
    equal(selection.event, before + 1, "keys work as before");
  }

  async function buildsPassByPass() {
    const regions = indices().filter((i) => events.kind[i] === events.REGION);
    equal(selection.event, regions[regions.length >> 1], "a construction opens halfway");
    selection.goTo(0);
    equal(wrappers.sizes[0], events.bodies[0].realCount, "where the front has the body's faces");
    byId("play-what").value = "pass";
    let passes = 0;
    for (let next = timeline.next(); next; next = timeline.next()) {
      next();
      if (events.kind[selection.event] !== events.PASS_END) continue;
      passes++;
      if (!recordedSize(selection.event)) check(false, "the front after a pass", wrappers.sizes);
    }
    equal(passes, events.passes.length, "passes can be played one by one");
    equal(wrappers.sizes[0], wrappers.outermost[0], "to the outermost wrapper");
  }

  /** The attempts at a vertex and a region, as the trace has them. */
  async function listsAttempts() {
    const slices = trace().traceEvents.filter((e) => e.ph === "X" && e.args.event !== undefined),
      named = (name) => slices.filter((e) => e.name === name).map((e) => e.args),
      patches = new Map(named("patch").map((patch) => [patch.event, patch])),
      caps = named("cap"),
      rows = () => [...byId("attempt-rows").children],
      capsAt = (v) => caps.filter((c) => (patches.get(c.cause).vertices || []).includes(v)),
      shown = () => rows().map((r) => events.id(r.attempt.cap)).join(" ");
    const vertices = [...Array(events.bodies[0].vertices.length / 3).keys()],
      busiest = vertices.reduce((p, q) => (capsAt(q).length > capsAt(p).length ? q : p)),
      tried = capsAt(busiest);
    check(tried.length > 2, "several caps were tried at one vertex", tried.length);
    selection.pickVertex(0, busiest);
    equal(shown(), tried.map((c) => c.event).join(" "), "the panel lists the attempts at a vertex, in order");
    const rejected = tried.findIndex((c) => c.verdict !== "stands");
    rows()[rejected].click();
    await frame();
    equal(events.id(selection.event), tried[rejected].event, "a click on a row goes to its cap");
    const patch = view.attemptFaces(events.attempts.ofEvent.get(selection.event)),
      { faces } = patches.get(tried[rejected].cause);
    equal(patch.length, faces, "the view shows the patch with all its faces");
    const region = events.bodies[0].regionCount >> 1,
      made = named("region").find((r) => r.region === region);
    selection.pickRegion(0, region);
    check(shown().split(" ").includes(String(made.cause)), "a region lists what made it", shown());
    rows().find((r) => events.id(r.attempt.cap) === made.cause).click();
    await frame();
    const after = wrappers.sizes[0];
    press("b");
    check(wrappers.sizes[0] > after, "B shows the front before it", `${wrappers.sizes[0]} ${after}`);
    press("b");
    equal(wrappers.sizes[0], after, "and again the front after it");
    location.hash = `#e0&pick=A.vertex.${busiest}`;
    run.address.read();
    equal(selection.picked && selection.picked.vertex, busiest, "an address leads to a vertex");
  }

  /** Bodies of the plane are seen from above, and cannot be turned. */
  async function liesFlat() {
    const { camera } = view,
      position = () => camera.camera.position.toArray().join();
    view.frameAll();
    await frame();
    const before = position();
    for (const key of ["a", "e", "o"]) press(key);
    await frame();
    equal(position(), before, "keys do not turn flat bodies");
    const direction = camera.camera.position.clone().sub(camera.controls.target).normalize();
    check(direction.z > 0.999, "they are seen from above", direction.toArray());
    const [body] = events.bodies,
      [p, q] = body.face(0),
      midpoint = [0, 1, 2].map((i) => (body.vertices[3 * p + i] + body.vertices[3 * q + i]) / 2),
      hit = view.picker.under(...screenOf(view.views[0].toWorld(midpoint)), true);
    check(hit && hit.side === 0 && hit.face === 0, "a click finds the segment under it", JSON.stringify(hit));
  }

  /** A body without regions is never called a wrapper. The view looks as the scenario's first one. */
  async function showsTheOpenBody() {
    const { camera } = view,
      direction = () => camera.camera.position.clone().sub(camera.controls.target).normalize();
    selection.goTo(events.kind.indexOf(events.STEP));
    view.frameAll(camera.from);
    await frame();
    const caption = text("view-caption");
    check(caption.includes("A (it has no wrapper) and B's outermost wrapper"), "the caption says so");
    const legend = text("legend");
    check(
        /A: open.*pseudo faces of B/.test(legend) && !/faces of A/.test(legend),
        "the legend has no pseudo faces of A", legend);
    const wanted = new THREE.Vector3(0.5, 0.6, 0.6).normalize();
    check(direction().distanceTo(wanted) < 1e-6, "looks from where frames do", direction().toArray());
    camera.turn(0.7, 0);
    check(Math.abs(direction().y - wanted.y) < 1e-6, "turns about the axis that is up");
  }

  /** Distance and depth: a line or an arrow in every step that has one, with its length in words. */
  async function measures() {
    for (const [step, { result }] of trace().metadata.steps.entries()) {
      selection.goTo(events.firstOfStep[step]);
      await frame();
      const apart = result.distance.lower > 0,
        deep = result.clash.depth && result.clash.depth[1] > 0;
      equal(byId("measured").hidden, !(apart || deep), `step ${step} has its length`);
      if (!apart && !deep) continue;
      const { from, to } = view.measured.shown,
        length = to.distanceTo(from) * run.scene.unit,
        wanted = apart ? result.distance.upper : result.clash.depth[1];
      const off = Math.abs(length - wanted) / run.scene.unit;
      check(off < 1e-5, "as the trace says", `${length}, not ${wanted}`);
      check(text("measured").startsWith(apart ? "distance " : "depth "), "in words", text("measured"));
    }
  }

  const parts = {
    measured: [measures],
    open: [opensAtLargestContact, showsTheOpenBody],
    plane: [opensAtLargestContact, replaysAsRecorded, liesFlat],
    build: [replaysAsRecorded, buildsPassByPass, listsAttempts],
    reload: [opensAtItsAddress],
    screen: [fitsOneScreen],
    all: [
      ...[opensAtLargestContact, showsOneStep, replaysAsRecorded, selectsEverywhere, clicks, filters],
      ...[showsWrongPairs, explains, mapsAllPairs, rowsLead, keepsItsState, loadsTheTrace],
    ],
    flat: [opensAtLargestContact, withoutWebgl],
  };
  driven.run(frame, ...parts[new URLSearchParams(location.search).get("drive")]);
})();
