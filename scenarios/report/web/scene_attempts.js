import { byId, digits, element, linkRow, short } from "./dom.js";
import { grouped, lastAtMost, NONE, outcomeText, unpack } from "./scene_run.js";

// ---- the attempts of a builder to cover parts of the front with caps, and the places where they were made,
// as in scenarios/record/attempts.hpp

const ACCEPTED = "accepted"; // the verdict
export class Attempts {
  /** `json`: {counts, vertices, verdicts}: the interior vertices of each patch, and what verdicts mean. */
  constructor(events, json) {
    this.events = events;
    this.body = events.bodies[0];
    this.verdicts = json.verdicts;
    this.take({ counts: unpack(json.counts), vertices: unpack(json.vertices) });
  }

  /** Takes the vertices of the patches among the events: {counts: of each patch, vertices}. */
  take({ counts, vertices }) {
    const { events } = this, vertexCount = this.body.complete ? this.body.vertices.length / 3 : 0;
    this.list = []; // {patch, cap, regions: [{event, region}], vertex, vertices, rejected}, events by index
    this.ofEvent = new Map(); // by index of a patch, a cap or a region
    this.made = new Map(); // by region: the event that made it
    const ofPatch = new Map();
    let patch = 0, first = 0;
    for (let i = 0; i < events.count; i++) {
      const kind = events.kind[i], cause = events.find(events.cause[i]);
      if (kind === events.PATCH) {
        ofPatch.set(i, vertices.subarray(first, first + counts[patch]).filter((v) => v < vertexCount));
        first += counts[patch++];
      } else if (kind === events.CAP && ofPatch.has(cause)) {
        const attempt = {
          patch: cause,
          cap: i,
          regions: [],
          vertex: events.a[cause],
          vertices: ofPatch.get(cause),
          whole: events.depthA[cause] === 0, // a whole component, at no place in particular
          rejected: outcomeText(events, i) !== ACCEPTED,
        };
        this.list.push(attempt);
        this.ofEvent.set(i, attempt);
        if (!this.ofEvent.has(cause)) this.ofEvent.set(cause, attempt);
      } else if (kind === events.REGION) {
        this.made.set(events.a[i], i);
        const attempt = this.ofEvent.get(cause);
        if (!attempt) continue;
        attempt.regions.push({ event: i, region: events.a[i] });
        this.ofEvent.set(i, attempt);
      }
    }
    this.atVertex = new Map();
    for (const attempt of this.list)
      for (const v of this.placesOf(attempt))
        this.atVertex.set(v, [...(this.atVertex.get(v) || []), attempt]);
    this.cache = { key: "", list: [], events: new Set() };
  }

  /** Returns the vertices that an attempt could cover; its start vertex if they are not known. */
  placesOf({ vertices, vertex, whole }) {
    return vertices.length ? vertices : whole ? [] : [vertex];
  }

  /** Returns the faces around each vertex. */
  get around() {
    if (!this.aroundVertex) {
      const { body } = this,
        faces = Uint32Array.from(body.corners, () => 0);
      for (let f = 0; f < body.faceCount; f++) faces.fill(f, body.offsets[f], body.offsets[f + 1]);
      const corners = grouped(body.corners, body.vertices.length / 3);
      this.aroundVertex = (v) => [...corners.of(v)].map((c) => faces[c]);
    }
    return this.aroundVertex;
  }

  /** Returns the vertices that a region covers: of its floor, and not of its lids. */
  coveredBy(region) {
    const { body } = this,
      kept = new Set([...body.lids(region)].flatMap((f) => [...body.face(f)]));
    return [...new Set([...body.floor(region)].flatMap((f) => [...body.face(f)]))]
        .filter((v) => !kept.has(v));
  }
  /** Returns the region that covers a vertex; NONE: the outermost wrapper has it. */
  coverOf(vertex) {
    const regions = this.around(vertex).flatMap((f) => [this.body.inner[f], this.body.outer[f]]);
    return [...new Set(regions)].find((r) => r < this.body.regionCount && this.coveredBy(r).includes(vertex))
        ?? NONE;
  }

  /** Returns the attempts at a selected vertex, face or region, and the set of their events. */
  there(picked) {
    const key = picked && this.body.complete ? `${picked.vertex} ${picked.face} ${picked.region}` : "";
    if (this.cache.key !== key) {
      const list = key ? this.find(picked) : [];
      this.cache = { key, list,
          events: new Set(list.flatMap((a) => [a.patch, a.cap, ...a.regions.map((r) => r.event)])) };
    }
    return this.cache;
  }
  at(picked) {
    return this.there(picked).list;
  }
  eventsAt(picked) {
    return this.there(picked).events;
  }

  find({ vertex, face, region }) {
    const { body } = this,
      among = (vertices) => new Set([...vertices].flatMap((v) => this.atVertex.get(v) || [])),
      inOrder = (set) => [...set].sort((p, q) => p.cap - q.cap);
    if (vertex !== NONE) return inOrder(among([vertex]));
    if (face !== NONE) {
      // While the face is on the front: from the region beneath it to the one over it.
      const from = this.made.get(body.inner[face]) ?? -1,
        to = this.made.get(body.outer[face]) ?? this.events.count,
        cover = this.ofEvent.get(to);
      const there = [...among(body.face(face))].filter((a) => a.cap > from && a.cap < to);
      return inOrder(new Set(cover ? [...there, cover] : there));
    }
    const maker = this.ofEvent.get(this.made.get(region));
    return inOrder(new Set([...among(this.coveredBy(region)), ...(maker ? [maker] : [])]));
  }

  /** Returns the faces of an attempt's patch on the front after the current event: [{side, face}]. */
  facesOf(attempt, wrappers) {
    if (attempt.whole && !attempt.vertices.length) return [];
    const { vertices, vertex } = attempt,
      faces = new Set([...(vertices.length ? vertices : [vertex])].flatMap((v) => this.around(v)));
    return [...faces].filter((f) => wrappers.onBoundary(0, f)).map((face) => ({ side: 0, face }));
  }

  /** Returns the event that shows what covers an attempt's patch; before, `cap` shows the patch. */
  after({ cap, regions }) {
    return regions.length ? regions[regions.length - 1].event : cap;
  }

  /** Returns why an attempt was rejected, or that it was not, in plain words. */
  reason(attempt) {
    const verdict = outcomeText(this.events, attempt.cap), pass = this.events.pass(attempt.cap),
      limit = verdict === "too thick" && pass && pass.limit > 0 ? ` (${short(pass.limit)})` : "";
    return `${this.verdicts[verdict] || ""}${limit}`;
  }

  /** Selects the place of an event: the region that it made, or the start vertex of its patch. */
  pickPlace(event, selection) {
    const { events } = this;
    if (!this.body.complete) return;
    if (events.kind[event] === events.REGION) selection.pickRegion(0, events.a[event]);
    else if (this.ofEvent.has(event)) selection.pickVertex(0, this.ofEvent.get(event).vertex);
  }
}

// ---- beside the view: the attempts at the selected place
export class AttemptPanel {
  constructor(attempts, selection) {
    Object.assign(this, { attempts, selection, events: attempts.events });
    byId("attempt-before").onclick = () => this.show(this.current, false);
    byId("attempt-after").onclick = () => this.show(this.current, true);
    selection.on("pick", () => this.list());
    selection.onContent(() => this.mark());
  }

  get here() {
    return this.attempts.at(this.selection.picked);
  }
  /** The attempt of the current event. */
  get current() {
    return this.attempts.ofEvent.get(this.selection.event);
  }

  show(attempt, after = true) {
    if (attempt) this.selection.goTo(after ? this.attempts.after(attempt) : attempt.cap);
  }
  /** Changes between the front before the current attempt and after it. */
  flip() {
    if (this.current) this.show(this.current, this.selection.event !== this.attempts.after(this.current));
  }
  /** Moves among the attempts at the selected place. */
  step(by) {
    const { here } = this;
    if (!here.length) return;
    const last = lastAtMost(here.map((a) => a.patch), this.selection.event),
      at = here[last] === this.current || by > 0 ? last + by : last;
    this.show(here[Math.max(0, Math.min(here.length - 1, at))]);
  }

  list() {
    const { picked } = this.selection, { events, here } = this;
    byId("attempts").hidden = !picked || !this.attempts.body.complete;
    if (byId("attempts").hidden) return;
    const rejected = here.filter((a) => a.rejected).length,
      accepted = here.length - rejected,
      more = events.ids ? " among the events of this page" : "";
    byId("attempts-title").textContent = `Attempts here: ${rejected} rejected, ${accepted} accepted${more}`;
    byId("attempts-note").textContent = here.length ? "" : picked.vertex !== NONE || picked.face !== NONE
        ? "No patch with this part of the front inside was tried." : "";
    byId("attempts-table").hidden = !here.length;
    byId("attempt-rows").replaceChildren(...here.map((a) => this.row(a)));
  }

  row(attempt) {
    const { events, attempts } = this, row = element("tr"), pass = events.pass(attempt.cap),
      cell = (content, numeric, title) => {
        const td = element("td", { class: numeric ? "n" : "", title }, content);
        row.append(td);
        return td;
      };
    const [faces, covered] = [events.a[attempt.cap], events.b[attempt.cap]];
    cell(pass ? pass.words.split(":")[0].replace("pass ", "") : "", true, pass ? pass.words : "");
    cell(digits(events.b[attempt.patch]), true, "faces of the patch");
    cell(covered ? `${digits(faces)} for ${digits(covered)}` : "none", false,
        "faces of the cap, for the faces of the front that it replaces");
    cell(outcomeText(events, attempt.cap), false, "").append(element("small", {}, attempts.reason(attempt)));
    linkRow(row, () => this.show(attempt));
    row.attempt = attempt;
    return row;
  }

  /** Marks the attempt of the current event. */
  mark() {
    const { current } = this;
    for (const row of byId("attempt-rows").children) {
      if (row.attempt === current) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
    }
    const after = current && this.selection.event === this.attempts.after(current) && !current.rejected;
    byId("attempt-parts").hidden = !current;
    if (!current) return;
    byId("attempt-before").setAttribute("aria-pressed", !after);
    byId("attempt-after").setAttribute("aria-pressed", Boolean(after));
    byId("attempt-after").disabled = !current.regions.length;
    byId("attempt-kept").textContent = !current.rejected ? ""
      : "Rejected: the front stays as it is. The trace has the patch and the size of the cap, not its shape.";
  }
}
