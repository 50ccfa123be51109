// Operates a live page with mouse and keys, and prints "ok ..." or "FAIL ..." for each check, the answers that live.sh compares with
// native ones, then "done".
(async function () {
  const { byId } = dom_js,
    { live } = drag_js,
    lines = [],
    wait = (ms) => new Promise((then) => setTimeout(then, ms)),
    check = (is, what, found = "") => lines.push(`${is ? "ok" : "FAIL"} ${what}${is ? "" : `: ${found}`}`),
    text = (id) => byId(id).textContent,
    plain = (id) => text(id).replace(/\D/g, "");
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

  // Time is virtual here: it does not wait for the engine, which another thread compiles, nor for pictures.
  const started = async () => {
    let page = null;
    live.then((p) => (page = p));
    for (let i = 0, x = 0; i < 20000 && !page; i++) {
      for (let k = 0; k < 3e6; k++) x += Math.sqrt(k);
      await wait(x < 0 ? 20 : 10);
    }
    return page;
  };
  const settled = async (page) => {
    await wait(20);
    if (page.soon.waiting) page.changed();
    page.view.draw();
  };
  const pointer = (type, x, y, more = {}) =>
    byId("view-canvas").dispatchEvent(
      new PointerEvent(type, { clientX: x, clientY: y, pointerId: 1, bubbles: true, buttons: type === "pointerup" ? 0 : 1, ...more }),
    );
  const report = () => {
    lines.push(`dragged to ${byId("pose").value}`);
    lines.push(`dragged answer ${text("relation-cell").replace(/ /g, "_")} ${plain("pairs")} ${text("fingerprint")}`);
  };

  /** Returns a point of the screen where B is seen. */
  const pointOnB = (page) => {
    const box = byId("view-canvas").getBoundingClientRect();
    for (let y = 0.1; y < 1; y += 0.02)
      for (let x = 0.1; x < 1; x += 0.02) {
        const at = [box.left + x * box.width, box.top + y * box.height];
        if (page.view.isOverB(...at)) return at;
      }
    return null;
  };
  const drag = async (page, [x, y], [right, down], more) => {
    pointer("pointerdown", x, y, more);
    check(!page.view.camera.controls.enabled, "dragging B does not turn the camera");
    for (let i = 1; i <= 8; i++) {
      pointer("pointermove", x + (right * i) / 8, y + (down * i) / 8, more);
      await settled(page);
    }
    pointer("pointerup", x + right, y + down, more);
    await wait(50);
    check(page.view.camera.controls.enabled, "afterwards the camera can be turned");
  };

  try {
    const page = await started();
    check(page, "the page starts", text("failed"));
    check(byId("failed").hidden, "without a complaint", text("failed"));
    const { query } = page.engine;
    page.engine.query = (poses) => query.call(page.engine, poses); // once: nothing measures virtual time
    await settled(page);
    for (const line of byId("poses").textContent.trim().split("\n")) {
      const answer = page.engine.query([identity, line.split(" ").map(Number)]);
      lines.push(`pose ${answer.relation} ${answer.pairs[0].length} ${answer.fingerprint}`);
    }

    report();
    const first = byId("pose").value,
      camera = page.view.camera.camera.position.toArray().join();
    check(page.answer.pairs[0].length > 0, "the bodies meet at first", page.answer.relation);
    check(page.view.marks.shown.get("contacts").parts.length > 0, "and faces in contact are marked");
    await drag(page, pointOnB(page), [60, -25]);
    report();
    const moved = byId("pose").value;
    check(moved !== first, "dragging B moves it");
    const same = moved.split(" ").filter((x, i) => i % 4 !== 3 && x === first.split(" ")[i]).length;
    check(same === 9, "and does not rotate it", same);
    await drag(page, pointOnB(page), [40, 30], { shiftKey: true });
    report();
    const turned = byId("pose").value.split(" ").filter((x, i) => i % 4 !== 3 && x === moved.split(" ")[i]).length;
    check(turned < 9, "dragging with shift rotates it");
    check(page.view.camera.camera.position.toArray().join() === camera, "the camera stays");
    await drag(page, pointOnB(page), [-400, 200]);
    report();

    const press = async (key, more = {}) => {
      byId("view-canvas").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }));
      await settled(page);
    };
    for (const [key, more] of [["ArrowLeft"], ["PageUp"], ["ArrowUp", { shiftKey: true }]]) {
      const before = byId("pose").value;
      await press(key, more);
      check(byId("pose").value !== before, `${key} changes the pose`);
    }
    report();
    await wait(400);
    check(location.hash === `#pose=${byId("pose").value.split(" ").join(",")}`, "the address has the pose", location.hash);
    await press("r");
    check(byId("pose").value === first, "R returns to the first pose", byId("pose").value);
    byId("pose").value = moved;
    byId("apply").click();
    check(byId("pose").value === moved, "a pose that is typed in is kept to the last bit", byId("pose").value);
    byId("pose").value = "1 2 3";
    byId("apply").click();
    check(text("pose-state").includes("12"), "a wrong one is refused", text("pose-state"));
    check(byId("pose").getAttribute("aria-invalid") === "true", "and marked");
    page.reset();
    await settled(page);
    const row = byId("pair-rows").firstElementChild;
    row.click();
    check(page.view.marks.shown.get("picked").parts.length > 0, "a click on a pair marks its faces");
    check(!complaints.length, "nothing in the console", complaints.join("; "));
    lines.push("done");
  } catch (e) {
    lines.push(`FAIL ${e.stack || e}`);
  }
  const out = document.createElement("pre");
  out.id = "driven";
  out.textContent = lines.join("\n");
  document.body.append(out);
})();
