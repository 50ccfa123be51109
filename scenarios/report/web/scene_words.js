// ---- an event, a face, a region in words
/** Returns a whole number with its digits in groups, as the rest of the page has them. */
const digits = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
const plural = (n, one, many = one + "s") => `${digits(n)} ${n === 1 ? one : many}`;
const relationWords = (name) =>
  ({ a_inside_b: "A inside B", b_inside_a: "B inside A" })[name] || name.replaceAll("_", " ");

/** Returns what an event is about. */
function eventWords(events, i) {
  const two = events.bodies.length > 1,
    kind = events.kind[i],
    a = events.a[i],
    b = events.b[i];
  const side = two ? ` of ${SIDES[events.side[i]]}` : "";
  if (events.passes) return builtWords(events, i);
  if (kind === events.STEP) return firstWrapperWords(events.bodies);
  if (kind === events.REFINE) return `region ${digits(a)}${side}: ${plural(b, "face")} under it`;
  if (kind === events.COARSEN) return `region ${digits(a)}${side} added`;
  if (kind === events.RESULT)
    return `${relationWords(events.relations[a])}: ${plural(b, "pair of faces meets", "pairs of faces meet")}`;
  const faces = events.faces(i);
  if (faces.length)
    return faces.map((f) => `${events.bodies[f.side].faceWords(f.face)} of ${SIDES[f.side]}`).join(", ");
  const { a: ra, b: rb } = events.kindOf(i);
  const one = (r, n) => {
    if (r.sort === "phase") return events.phases[n];
    return `${r.words} ${digits(n)}${r.sort === "vertex" ? side : ""}`;
  };
  return [
    [ra, a],
    [rb, b],
  ]
    .filter(([r, n]) => r.sort && n !== NONE)
    .map(([r, n]) => one(r, n))
    .join(", ");
}

/** Returns what a step begins with. A body without regions, such as an open one, has no wrapper. */
function firstWrapperWords(bodies) {
  const bare = bodies.filter((b) => !b.regionCount);
  if (bodies.length === 1) return bare.length ? "the body itself, which has no wrapper" : "the outermost wrapper";
  if (bare.length === 2) return "the bodies themselves, which have no wrappers";
  if (!bare.length) return "both wrappers are the outermost ones";
  return `${SIDES[bare[0].side]} itself, which has no wrapper; ${SIDES[1 - bare[0].side]}'s is the outermost one`;
}

/** Returns how many faces are shown of each body: of its wrapper, or of itself where it has none. */
function sizeWords(bodies, sizes) {
  const one = (n, side) =>
    `${bodies.length > 1 ? `${SIDES[side]} ` : ""}${digits(n)}${bodies[side].regionCount ? "" : " (no wrapper)"}`;
  return `${sizes.map(one).join(" + ")} faces`;
}

/** Returns what an event of a construction is about. */
function builtWords(events, i) {
  const a = events.a[i],
    b = events.b[i];
  switch (events.kind[i]) {
    case events.STEP:
      return "the body itself";
    case events.PASS:
      return `pass ${digits(a + 1)} begins`;
    case events.PATCH:
      return `${plural(b, "face")}, grown from vertex ${digits(a)}`;
    case events.CAP:
      return b ? `${plural(a, "face")} over ${digits(b)}` : "none: nothing could be left out";
    case events.REGION:
      return `region ${digits(a)}: ${plural(b, "face")} under it`;
    case events.PASS_END:
      return events.pass(i).words;
  }
  const kind = events.kindOf(i);
  return `${digits(a)} ${kind.a.words}, ${digits(b)} ${kind.b.words}`;
}

/** Returns how an event came out; empty: nothing can be said. */
const outcomeWords = (events, i) => events.outcomes[events.outcome[i]] || "";

/** Returns where an event is in the run. */
function eventPlace(events, i) {
  const event = `event ${digits(events.id(i))}`;
  return events.firstOfStep.length > 1
    ? `Step ${digits(events.stepNumber(i))}, ${event}`
    : `E${event.slice(1)}`;
}

/** Returns a sentence on an event and the wrappers after it. */
function eventSentence(events, wrappers, i) {
  const meet = outcomeWords(events, i);
  const result = meet ? ` (${meet})` : "";
  const about = `${eventPlace(events, i)}, ${events.kindOf(i).name}: ${eventWords(events, i)}${result}.`;
  if (!wrappers) return about;
  if (events.passes) return `${about} Hull: ${digits(wrappers.sizes[0])} faces.`;
  return `${about} ${wrappers.sizes.length > 1 ? "Wrappers" : "Wrapper"}: ${sizeWords(events.bodies, wrappers.sizes)}.`;
}
