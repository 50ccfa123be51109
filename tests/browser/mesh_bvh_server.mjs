// mesh_bvh_server.mjs FOLDER: serves the files of FOLDER on 127.0.0.1, and opens its page in Chromium by the
// shell's function `browse`. Appends what the page posts to /capture to the pipe of `lrbscope live`, and
// writes what it posts to /found to a file. Answers /capture?queries=N after the page of `live`, whose
// address is in FOLDER/live.log, lists N queries.
import { spawn } from "child_process";
import fs from "fs";
import http from "http";

const folder = process.argv[2], pipe = fs.openSync(process.env.LRBCAP_OUT, "w");
const live = /http:\S*/.exec(fs.readFileSync(`${folder}/live.log`, "utf8"))[0];

async function followed(queries) {
  const events = await fetch(new URL("events", live)), decoder = new TextDecoder();
  let text = "";
  for await (const bytes of events.body) {
    text += decoder.decode(bytes, { stream: true });
    if (new RegExp(`"number": ?${queries}\\b`).test(text)) return;
  }
  throw Error(`${live} ended before query ${queries}`);
}

async function answer(request) {
  const url = new URL(request.url, "http://127.0.0.1");
  if (request.method === "GET")
    return fs.readFileSync(folder + (url.pathname === "/" ? "/index.html" : url.pathname));
  const body = Buffer.concat(await request.toArray());
  if (url.pathname === "/capture") fs.writeSync(pipe, body);
  else fs.writeFileSync(`${folder}${url.pathname}.json`, body);
  if (url.searchParams.has("queries")) await followed(url.searchParams.get("queries"));
  return "";
}

const server = http.createServer(async (request, response) => {
  try {
    const content = await answer(request);
    response.setHeader("Content-Type", /js$/.test(request.url) ? "text/javascript" : "text/html")
        .end(content);
  } catch (error) {
    response.writeHead(500).end(error.stack);
  }
});
server.listen(0, "127.0.0.1", () => {
  const page = fs.openSync(`${folder}/dom`, "w");
  spawn("bash", ["-c", `browse http://127.0.0.1:${server.address().port}/`], {
    stdio: ["ignore", page, "inherit"]
  }).on("exit", (code) => process.exit(code ?? 1));
});
