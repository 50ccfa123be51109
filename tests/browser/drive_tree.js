// Operates the page of a tree with mouse and keys, and prints "ok ..." or "FAIL ..." for each check, then
// "done".
(function () {
  const { check, equal, press } = driven,
    { treePage } = tree_js,
    { nodes, body, view } = treePage,
    { byId } = dom_js,
    words = (id) => byId(id).textContent;

  /**
     Returns the number of faces with a point clearly in the volume of a node, which are not marked as below
     it or in it: none is expected.
   */
  function unmarkedFaces() {
    const { places } = body.boxes,
      at = places.subarray(12 * treePage.node, 12 * treePage.node + 12),
      isIn = (p) =>
        [3, 6, 9].every((k) => {
          const w = at.subarray(k, k + 3),
            along = [0, 1, 2].reduce((sum, i) => sum + w[i] * (p[i] - at[i]), 0),
            reach = w.reduce((sum, x) => sum + x * x, 0);
          return Math.abs(along) < 0.98 * reach;
        });
    let unmarked = 0;
    for (let face = 0; face < treePage.faces.length; face++) {
      const [p, q, r] = [...body.face(face)].map((v) => [...body.vertices.subarray(3 * v, 3 * v + 3)]);
      let inside = false;
      for (let i = 0; i <= 4; i++)
        for (let j = 0; i + j <= 4; j++)
          inside ||= isIn(p.map((x, k) => x + ((q[k] - x) * i) / 4 + ((r[k] - x) * j) / 4));
      unmarked += inside && treePage.kinds[face] === 0;
    }
    return unmarked;
  }

  function opensAtTheWorst() {
    const row = document.querySelector("tr[data-to^=node]"),
      cells = [...row.cells].map((c) => c.textContent);
    equal(byId("node").value, cells[0], "opens at the first row of the table");
    equal(row.getAttribute("aria-current"), "true", "which is marked");
    equal(words("node-depth"), cells[1], "with its depth");
    equal(words("node-triangles").split(" ")[0], cells[2], "and the triangles below it");
    equal(words("node-area"), cells[3], "and its area");
    equal(location.hash, `#node=${cells[0]}`, "the address names it");
    equal(unmarkedFaces(), 0, "all faces with a point in its volume are marked");
  }

  function selects() {
    const root = document.querySelector(`[data-node="${nodes.ids[0]}"]`);
    root.dispatchEvent(new MouseEvent("click", { bubbles: true }));
    equal(treePage.node, 0, "a click on the icicle's top selects the root");
    equal(words("node-others"), "0 triangles", "in whose volume there is nothing else");
    equal(words("node-area"), "1", "and whose area is the measure");
    press("ArrowDown");
    equal(nodes.parent[treePage.node], 0, "arrow down goes to a child");
    const first = treePage.node;
    press("ArrowRight");
    check(treePage.node !== first && nodes.parent[treePage.node] === 0, "arrow right to its sibling");
    equal(unmarkedFaces(), 0, "all faces with a point in its volume are marked");
    press("ArrowLeft");
    press("ArrowUp");
    equal(treePage.node, 0, "arrow left and up go back");
    press("c");
    equal(view.marks.shown.get("others").parts.length > 0, true, "the volumes of the children are shown");
    press("c");
    byId("node").value = "no number";
    byId("node").onchange();
    check(words("node-state").startsWith("no such node"), "an unknown node is refused", words("node-state"));
    equal(treePage.node, 0, "and the selection stays");
    nodes.indexOf.set((nodes.ids[1] = "5 of instance 2"), 1);
    treePage.select(1);
    const { hash } = location;
    treePage.select(0);
    history.replaceState(null, "", hash);
    window.dispatchEvent(new Event("hashchange"));
    equal(treePage.node, 1, `the address of a node of an instance leads to it: ${hash}`);
  }

  function clicks() {
    const box = byId("view-canvas").getBoundingClientRect(),
      at = { clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, bubbles: true },
      hit = view.nearest(at.clientX, at.clientY, [view.views[0].real]);
    check(hit !== null, "the body is in the middle");
    for (const type of ["pointerdown", "click"]) byId("view-canvas").dispatchEvent(new MouseEvent(type, at));
    const { node } = treePage;
    check(
        nodes.first[node] <= hit.face && hit.face < nodes.last[node], "a click selects a node with the face");
    equal(nodes.children(node).length, 0, "which is a leaf");
    equal(treePage.kinds[hit.face], 2, "and the face is below it");
    press("i");
    view.draw();
    const shown = view.views[0].real.mesh.geometry.drawRange.count / 3;
    equal(shown, treePage.kinds.filter((k) => k > 0).length, "isolating shows the faces in the volume alone");
    press("i");
    press("f");
    press("F");
  }

  driven.run(opensAtTheWorst, selects, clicks);
})();
