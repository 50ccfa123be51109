// Keeps what the page complains about, from its first script on.
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
