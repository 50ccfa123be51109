// Before all scripts of a page: keeps what it complains about, and has what its drivers share.
const complaints = [];
for (const name of ["error", "warn"]) {
  const print = console[name];
  console[name] = (...words) => {
    complaints.push(words.join(" "));
    print.apply(console, words);
  };
}
addEventListener("error", (e) => complaints.push(`${e.message} at line ${e.lineno}`));
addEventListener("unhandledrejection", (e) => complaints.push(String(e.reason)));
addEventListener("securitypolicyviolation", (e) =>
  complaints.push(`refused: ${e.violatedDirective} ${e.blockedURI}`),
);

/** The checks of a driver. */
const driven = {
  lines: [],
  check: (is, what, found = "") =>
      driven.lines.push(`${is ? "ok" : "FAIL"} ${what}${is ? "" : `: ${found}`}`),
  equal: (found, wanted, what) => driven.check(found === wanted, what, `found ${found}, wanted ${wanted}`),
  press: (key, more = {}) =>
      document.body.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true, ...more})),

  /** Runs the parts of a driver in turn, and writes the results at the end of the page. */
  async run(...parts) {
    try {
      for (const part of parts) await part();
      driven.check(complaints.length === 0, "no messages in the console", complaints.join("; "));
    } catch (e) {
      driven.lines.push(`FAIL ${e.stack}`);
    }
    const out = document.createElement("pre");
    out.id = "driven";
    out.textContent = [...driven.lines, "done"].join("\n");
    document.body.append(out);
  },
};
