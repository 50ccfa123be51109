// ---- the fields that filter the table
class FilterForm {
  constructor(events, filter, table) {
    Object.assign(this, { events, filter, table });
    this.listeners = []; // told when another part of the work is listed
    this.listKinds();
    byId("filter-side").closest("label").hidden = byId("filter-pair").closest("label").hidden =
      events.bodies.length < 2;
    for (const field of ["kind", "side", "region", "level", "pair"])
      byId(`filter-${field}`).addEventListener("input", () => this.read());
    byId("filters").addEventListener("submit", (e) => e.preventDefault());
    byId("filter-clear").onclick = () => this.clear();
  }

  /** Offers the kinds of events that there are. */
  listKinds() {
    const kind = byId("filter-kind"),
      present = new Set(this.events.kind),
      chosen = kind.value;
    kind.replaceChildren(new Option("all", -1));
    this.events.kinds.forEach((k, i) => {
      if (present.has(i)) kind.append(new Option(k.name, i));
    });
    kind.value = chosen;
  }

  read() {
    const value = (field) => byId(`filter-${field}`).value.trim(),
      valid = (field, is) => byId(`filter-${field}`).setAttribute("aria-invalid", !is);
    this.filter.kind = Number(value("kind"));
    this.filter.side = Number(value("side"));
    valid("region", /^\d*$/.test(value("region")));
    this.filter.region = /^\d+$/.test(value("region")) ? Number(value("region")) : NONE;
    valid("level", this.filter.setLevel(value("level")));
    valid("pair", this.filter.setPair(value("pair")));
    byId("filter-work").hidden = !this.filter.work;
    byId("filter-work").textContent = this.filter.work ? `part: ${this.filter.work.name}` : "";
    this.table.refilter();
    for (const listener of this.listeners) listener();
  }

  clear() {
    this.filter.work = null;
    byId("filter-kind").value = byId("filter-side").value = "-1";
    for (const field of ["region", "level", "pair"]) byId(`filter-${field}`).value = "";
    this.read();
  }

  /** Lists the events of a part of the work; null: all. */
  showWork(work) {
    this.clear();
    this.filter.work = work;
    this.read();
  }

  /** Lists the events of a face, or of a region. */
  showPicked(picked) {
    this.clear();
    if (picked.face !== NONE)
      byId("filter-pair").value = picked.side === 0 ? `${picked.face},` : `,${picked.face}`;
    else {
      byId("filter-side").value = String(picked.side);
      byId("filter-region").value = String(picked.region);
    }
    this.read();
  }
}
