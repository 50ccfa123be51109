// ---- rows of the page's tables lead to regions and time steps, and show which of them is selected
class RowLinks {
  constructor(events, selection) {
    Object.assign(this, { events, selection, rows: [] });
    for (const table of document.querySelectorAll("table[data-rows]")) this.take(table);
    selection.listeners.push(() => this.mark());
    this.mark();
  }

  take(table) {
    const [sort, side] = table.dataset.rows.split(" ");
    if (sort === "region" && !this.events.bodies[side].complete) return;
    for (const row of table.tBodies[0].rows) {
      const text = row.cells[0].textContent;
      if (!/^[\d\u202f]+$/.test(text)) continue; // sums of others
      const link = { row, sort, side: Number(side), number: Number(text.replaceAll("\u202f", "")) };
      row.className = "leads";
      row.tabIndex = 0;
      row.addEventListener("click", () => this.follow(link));
      row.addEventListener("keydown", (e) => {
        if (e.key !== "Enter") return;
        e.preventDefault();
        this.follow(link);
      });
      this.rows.push(link);
    }
  }

  follow({ sort, side, number }) {
    if (sort === "region") this.selection.pickRegion(side, number);
    else seek("step", number);
    byId("stage").scrollIntoView({ block: "nearest" });
  }

  mark() {
    const { picked, event } = this.selection,
      step = this.events.stepNumber(event);
    for (const { row, sort, side, number } of this.rows) {
      const is =
        sort === "region" ? picked && picked.side === side && picked.region === number : step === number;
      if (is) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
    }
  }
}
