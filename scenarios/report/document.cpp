#include "scenarios/report/document.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::report {
namespace {

constexpr std::size_t kProse = 20;  // characters: longer cells are broken into lines if the table is too wide
constexpr std::size_t kLong = 30;   // rows: longer tables scroll separately

std::string embedded(const std::string& name) {
  return std::string(io::embedded_file(name));
}

bool looks_numeric(std::string_view cell) {
  // The last three bytes: a narrow space, between groups of digits.
  return cell.find_first_of("0123456789") != std::string_view::npos &&
         cell.find_first_not_of("0123456789.,+-eE %x\xE2\x80\xAF") == std::string_view::npos;
}

std::string cell_html(const std::string& cell, bool numeric) {
  const char* kind = numeric                ? " class=\"n\""
                     : cell == "FAILED"     ? " class=\"bad\""
                     : cell.size() > kProse ? " class=\"prose\""
                                            : "";
  return fill("<td{!}>{}</td>", {kind, cell});
}

/// `commands` are between backticks.
std::string text_html(const Text& text) {
  std::string html = render::escape_markup(text.text);
  std::size_t end = 0;
  for (std::size_t at = html.find('`'); at != std::string::npos; at = html.find('`', at)) {
    if (end = html.find('`', at + 1); end == std::string::npos) break;
    html.replace(end, 1, "</code>");
    html.replace(at, 1, "<code>");
  }
  return fill("<div><h2>{}</h2><p>{!}</p></div>\n", {text.title, html});
}

std::string tab_html(const std::string& name, const std::string& html) {
  return html.empty() ? "" : fill("<div class=\"tab\" data-tab=\"{}\">\n{!}</div>\n", {name, html});
}

PngBytes read_png_bytes(const std::string& path) {
  const std::string bytes = io::read_text(path);
  return {bytes.begin(), bytes.end()};
}

std::string uri_of(const std::string& file, const std::string& bytes) {
  return data_uri(file.ends_with(".svg") ? "image/svg+xml" : "image/png",
                  reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::string note_html(const std::string& note) {
  return note.empty() ? "" : fill("<p class=\"note\">{}</p>", {note});
}

std::string command_html(const std::string& command) {
  return fill("<pre class=\"command\"><code>{}</code></pre>", {command});
}

/// Without scripts, a page with a 3D view has its texts and tables; the pictures of a run are files.
constexpr const char* kNoScript =
    R"(<noscript><style>.scene, .frames, .charts { display: none; }</style><p class="note">The view, the charts and the events of this page need JavaScript. The pictures of the run are in <a href="frames/">frames/</a>.</p></noscript>
)";

constexpr const char* kNoScriptView =
    R"(<noscript><style>.scene, .charts { display: none; }</style><p class="note">The view and the charts of this page need JavaScript.</p></noscript>
)";

constexpr const char* kModes =
    R"(<div class="modes" role="group" aria-label="How to compare">
<button type="button" data-mode="side" aria-pressed="true">Side by side</button>
<button type="button" data-mode="swipe" aria-pressed="false">Swipe</button>
<button type="button" data-mode="difference" aria-pressed="false">Difference</button>
<input type="range" min="0" max="100" value="50" aria-label="Swipe: approved on the left, found on the right"></div>
)";

/// `uris`: of its pictures, in their order.
std::string comparison_html(const Comparison& c, const std::string* uris) {
  constexpr const char* kKinds[] = {"expected", "actual", "difference"};
  constexpr const char* kNames[] = {"Approved", "Found", "Difference, 16 times"};
  const char* outcome = c.passed ? "passed" : "failed";
  std::string out = fill(R"(<section class="comparison" id="{}"><h2>{} <span class="outcome {}">{}</span></h2>
<p class="finding">{}</p>
)",
                         {c.id, c.title, outcome, outcome, c.text});
  if (!c.pngs[0].empty() && !c.pngs[1].empty()) out += kModes;
  out += "<div class=\"pictures\" data-mode=\"side\">";
  for (std::size_t i = 0; i < c.pngs.size(); ++i)
    if (!c.pngs[i].empty())
      out += fill(
          R"(<figure class="{}"><figcaption><b>{}</b> {}</figcaption><img alt="{}, {}" src="{}"></figure>)",
          {kKinds[i], kNames[i], i < c.captions.size() ? c.captions[i] : "", c.title, kKinds[i], *uris++});
  out += "</div>\n";
  if (!c.command.empty()) out += note_html("If this is how it should be:") + command_html(c.command);
  return out + "</section>\n";
}

}  // namespace

Folder::Folder(std::string path)
    : path_(std::move(path)), existed_(std::filesystem::exists(path_)), lock_((make_folder(path_), path_)) {
  io::reject_links(path_);
}

Folder::~Folder() {
  std::error_code ignored;
  if (!existed_ && std::filesystem::is_empty(path_, ignored)) std::filesystem::remove(path_, ignored);
}

std::size_t characters_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string in_columns(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + (row.size() == rows[0].size() ? 0 : 1) < row.size(); ++i)
      widths[i] = std::max(widths[i], characters_of(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - std::min(widths[i], characters_of(row[i])), ' ');
      out += (i > 0 ? "  " : "") + (i < left ? row[i] + room : room + row[i]);
    }
    out.erase(out.find_last_not_of(' ') + 1) += "\n";
  }
  return out;
}

std::string in_columns(const Table& table, std::size_t left) {
  std::vector<std::vector<std::string>> rows = {table.columns};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  return in_columns(rows, left);
}

std::string csv(const Table& table) {
  std::string out;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) out += ",";
      if (row[i].find_first_of(",\"\r\n") == std::string::npos) {
        out += row[i];
        continue;
      }
      out += "\"";
      for (const char c : row[i]) out += c == '"' ? std::string("\"\"") : std::string(1, c);
      out += "\"";
    }
    out += "\n";
  };
  add(table.columns);
  for (const std::vector<std::string>& row : table.rows) add(row);
  return out;
}

namespace {

std::string tex(const std::string& text) {
  static constexpr std::pair<std::string_view, std::string_view> kForms[] = {
      {"\\", "\\textbackslash{}"},
      {"&", "\\&"},
      {"%", "\\%"},
      {"$", "\\$"},
      {"#", "\\#"},
      {"_", "\\_"},
      {"{", "\\{"},
      {"}", "\\}"},
      {"~", "\\textasciitilde{}"},
      {"^", "\\textasciicircum{}"},
      {"\u2013", "--"},
      {"\u202f", "\\,"},
      {"\u00b2", "\\textsuperscript{2}"},
      {"\u00b5", "\\textmu{}"}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto form = std::find_if(std::begin(kForms), std::end(kForms), [&](const auto& f) {
      return std::string_view(text).substr(i).starts_with(f.first);
    });
    if (form != std::end(kForms)) {
      out += form->second;
      i += form->first.size();
    } else {
      out += text[i++];
    }
  }
  return out;
}

/// Returns true if all cells of a column are numbers or dashes.
bool is_numeric(const Table& table, std::size_t column) {
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<std::string>& row) {
    return row[column] == "\u2013" || looks_numeric(row[column]);
  });
}

}  // namespace

std::string booktabs(const Table& table) {
  std::string out = "% \\usepackage{booktabs}\n\\begin{tabular}{";
  for (std::size_t i = 0; i < table.columns.size(); ++i) out += is_numeric(table, i) ? "r" : "l";
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) out += (i > 0 ? " & " : "") + tex(cells[i]);
    out += " \\\\\n";
  };
  out += "}\n\\toprule\n";
  line(table.columns);
  const auto continues = [&](std::size_t i) { return i > 0 && table.rows[i][0] == table.rows[i - 1][0]; };
  bool grouped = false;
  for (std::size_t i = 0; i < table.rows.size(); ++i) grouped |= continues(i);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::vector<std::string> row = table.rows[i];
    if (i == 0 || (grouped && !continues(i))) out += "\\midrule\n";
    if (continues(i)) row[0].clear();
    line(row);
  }
  return out + "\\bottomrule\n\\end{tabular}\n";
}

Document::Document(std::string title, std::string purpose)
    : title_(std::move(title)), purpose_(std::move(purpose)) {
  version(trace::lrbscope_version());
  styles_ = render::page_root_css() + embedded("page.css");
}

Document& Document::purpose(std::string_view more) {
  purpose_.append(purpose_.empty() ? "" : " ").append(more);
  return *this;
}

Document& Document::verdict(std::string word, bool good) {
  verdict_ = fill("<span class=\"verdict{!}\">{}</span>", {good ? "" : " bad", word});
  return *this;
}

Document& Document::version(std::string lrbscope) {
  footer_ = "lrbscope " + std::move(lrbscope) + ". This page is self-contained and fetches nothing.";
  return *this;
}

Document& Document::command(std::string command) {
  command_ = std::move(command);
  return *this;
}

Document& Document::link(const Link& link) {
  links_.push_back(link);
  return *this;
}

Document& Document::summary(std::string sentence) {
  summary_ = std::move(sentence);
  return *this;
}

Document& Document::explain(std::string_view (*meaning_of)(std::string_view name)) {
  meaning_of_ = meaning_of;
  return *this;
}

Document& Document::tab(const std::string& name) {
  if (name == tab_) return *this;
  close_charts();
  if (!tab_.empty()) body_ += "</div>\n";
  tab_ = name;
  if (!name.empty()) body_ += fill("<div class=\"tab\" data-tab=\"{}\">\n", {name});
  return *this;
}

std::string Document::tooltip(std::string_view name) const {
  const std::string_view meaning = meaning_of_ == nullptr ? std::string_view() : meaning_of_(name);
  return meaning.empty() ? "" : fill(" title=\"{}\"", {std::string(meaning)});
}

Document& Document::text(const Text& text) {
  texts_ += text_html(text);
  return *this;
}

Document& Document::reading(const Text& text) {
  reading_ += text_html(text);
  return *this;
}

Document& Document::number(const Number& number) {
  const std::string note = number.note.empty() ? "" : fill("<small>{}</small>", {number.note});
  numbers_ += fill("<div{!}><dt>{}</dt><dd>{}{!}</dd></div>\n",
                   {tooltip(number.label), number.label, number.value, note});
  return *this;
}

Document& Document::chart(const Chart& chart) {
  // A single point is a number, which a table has, not a chart.
  if (std::all_of(chart.series.begin(), chart.series.end(),
                  [](const Series& s) { return s.style.line != Line::none && s.x.size() < 2; }))
    return *this;
  if (chart_count_ == 0) libraries_ = embedded("chart.min.js") + libraries_;
  charts_ += (chart_count_ == 0 ? "" : ",") + chart_json(chart);
  return add(
      fill(
          R"(<figure class="chart"><figcaption><h2>{}</h2>{!}</figcaption><div class="plot"><canvas id="chart-{}" )"
          R"(role="img" aria-label="{}"></canvas></div></figure>
)",
          {chart.title, chart.note.empty() ? "" : fill("<p>{}</p>", {chart.note}),
           std::to_string(chart_count_++), chart.title}),
      true);
}

Document& Document::tables_as_tex(bool on) {
  tables_as_tex_ = on;
  return *this;
}

Document& Document::table(const Table& t) {
  if (tables_as_tex_ && t.columns.size() > 1) {
    std::string name;
    for (const char c : t.title)
      if (std::isalnum(static_cast<unsigned char>(c)) != 0)
        name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      else if (!name.empty() && name.back() != '-')
        name += '-';
    name.erase(name.find_last_not_of('-') + 1);
    file(name + ".tex", booktabs(t), t.title + ", for LaTeX");
  }
  // A column is aligned right if most of its cells are numbers.
  std::vector<std::size_t> numbers(t.columns.size());
  for (const std::vector<std::string>& row : t.rows)
    for (std::size_t c = 0; c < std::min(row.size(), numbers.size()); ++c)
      numbers[c] += looks_numeric(row[c]) || row[c] == "-" ? 1 : 0;
  const auto numeric = [&](std::size_t c) { return c < numbers.size() && 2 * numbers[c] > t.rows.size(); };
  std::string head, rows;
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    head +=
        fill("<th{!}{!}>{}</th>", {numeric(c) ? " class=\"n\"" : "", tooltip(t.columns[c]), t.columns[c]});
  for (std::size_t r = 0; r < t.rows.size(); ++r) {
    const bool leads = r < t.targets.size() && !t.targets[r].empty();
    const bool links = leads && (t.targets[r].front() == '#' || t.targets[r].ends_with(".html"));
    const bool drawn = r < t.pictures.size() && !t.pictures[r].empty();
    rows += leads && !links ? fill("<tr data-to=\"{}\">", {t.targets[r]}) : "<tr>";
    for (std::size_t c = 0; c < t.rows[r].size(); ++c)
      rows += links && c == 0
                  ? fill("<td><a href=\"{}\">{}{!}</a></td>",
                         {t.targets[r], t.rows[r][c],
                          drawn ? fill("<img alt=\"\" src=\"{}\">",
                                       {data_uri("image/png", t.pictures[r].data(), t.pictures[r].size())})
                                : std::string()})
                  : cell_html(t.rows[r][c], numeric(c));
    rows += "</tr>\n";
  }
  const std::string title = fill("<h2>{}</h2>", {t.title});
  return add(fill(R"(<section>{!}
<div class="scroll{!}"><table><thead><tr>{!}</tr></thead><tbody>
{!}</tbody></table></div>{!}{!}</section>
)",
                  {t.folded ? "<details><summary>" + title + "</summary>" : title,
                   t.rows.size() > kLong ? " long\" tabindex=\"0" : "", head, rows, note_html(t.note),
                   t.folded ? "</details>" : ""}));
}

Document& Document::grid(const Grid& grid, const std::string& folder) {
  use(render::grid_root_css() + embedded("grid.css"), "grid");
  std::vector<PngBytes> pngs;
  for (const GridDetail& d : grid.details)
    if (!d.file.empty()) pngs.push_back(read_png_bytes(folder + "/" + d.file));
  return add(grid_html(grid, inline_pngs(pngs)));
}

Document& Document::comparisons(const std::vector<Comparison>& comparisons) {
  use(embedded("comparison.css"), "comparison");
  std::vector<PngBytes> pngs;
  for (const Comparison& c : comparisons)
    for (const PngBytes& png : c.pngs)
      if (!png.empty()) pngs.push_back(png);
  const InlinedImages images = inline_pngs(pngs);
  const std::string* uris = images.uris.data();
  for (const Comparison& c : comparisons) {
    add(comparison_html(c, uris));
    uris += std::count_if(c.pngs.begin(), c.pngs.end(), [](const PngBytes& png) { return !png.empty(); });
  }
  return add(note_html(images.note));
}

Document& Document::views(const std::vector<View>& views) {
  if (views.empty()) return *this;
  use(embedded("views.css"), "views");
  framing_ = true;
  std::string frames;
  for (const View& v : views)
    frames +=
        fill(R"(<figure><figcaption>{}</figcaption><iframe src="{}?alone" title="{}"></iframe></figure>)",
             {v.title, v.target, v.title});
  return add(
      "<section class=\"views\"><h2>Seen by one camera</h2>\n<div class=\"pair\">" + frames + "</div>\n" +
      note_html(
          "These are the runs' own pages in frames; do not move them. Camera and time step are the same in both.") +
      "</section>\n");
}

Document& Document::view(const std::string& json, const std::string& name) {
  view_data_ = "<script type=\"application/json\" id=\"scene-data\">" + script_safe(json) + "</script>\n";
  for (const char* library : {"three.min.js", "OrbitControls.js"}) libraries_ += "\n" + embedded(library);
  use(embedded("scene.css"), name);
  return add(io::embedded_file(name + ".html"));
}

Document& Document::scene(const std::string& json) {
  of_run_ = true;
  return view(json, "scene");
}

Document& Document::tree_view(const std::string& json) {
  return view(json, "tree");
}

Document& Document::key_figures() {
  if (!numbers_.empty()) add("<dl class=\"numbers\">\n" + numbers_ + "</dl>\n");
  numbers_.clear();
  return *this;
}

Document& Document::frames(const std::vector<Frame>& frames, const std::string& folder, std::size_t budget) {
  if (frames.empty()) return *this;
  std::vector<PngBytes> pngs;
  for (const Frame& f : frames) pngs.push_back(read_png_bytes(folder + "/" + f.file));
  const InlinedImages images = inline_pngs(pngs, budget);
  auto json = nlohmann::json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& f = frames[i];
    json.push_back({{"src", images.uris[i]},
                    {"caption", f.caption},
                    {"file", f.file},
                    {"event", f.event},
                    {"step", f.step}});
  }
  frames_ = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const bool alone = !of_run_;
  const std::string keys = alone ? "Keys: ← → one frame, shift ten, Home, End, space plays. " : "";
  const std::string player =
      filled(io::embedded_file("player.html"), {{"keys", keys}, {"note", images.note}});
  add(alone ? player
            : fill(R"(<details class="frames" id="frames"><summary>Frames, as lrbscope drew them: {}</summary>
{!}</details>
)",
                   {std::to_string(frames.size()), player}));
  return link({"frames/", std::to_string(frames.size()) + " full pictures (PNG)"});
}

Document& Document::picture(const std::string& file, std::string bytes, const std::string& title,
                            const std::string& caption, bool live) {
  const std::string shown =
      live ? "<div class=\"live-picture\" tabindex=\"0\">" + bytes + "</div>"
           : fill("<a href=\"{}\"><img src=\"{!}\" alt=\"{}\"></a>", {file, uri_of(file, bytes), title});
  add(fill(R"(<section class="figure"><h2>{}</h2>
<figure>{!}<figcaption>{}</figcaption></figure></section>
)",
           {title, shown, caption}));
  return this->file(file, std::move(bytes), title);
}

Document& Document::picture(const std::string& file, const render::Image& image, const std::string& title,
                            const std::string& caption) {
  const PngBytes png = render::encode_png(image);
  return picture(file, {png.begin(), png.end()}, title, caption);
}

Document& Document::file(const std::string& name, std::string bytes, const std::string& note) {
  files_.emplace_back(name, std::move(bytes));
  return link({name, note});
}

std::string Document::print(const std::string& name, const std::string& note, const Gnuplot& chart,
                            bool as_pdf) {
  try {
    const std::string svg = drawn(chart, name + ".svg");
    if (as_pdf) file(name + ".pdf", drawn(chart, name + ".pdf"), note);
    file(name + ".svg", svg, note);
    if (!as_pdf) file(name + ".png", drawn(chart, name + ".png"), note + ", 300 dpi");
    return svg;
  } catch (const EnvironmentError& e) {
    notes_.emplace_back(e.what());
    return {};
  }
}

Document& Document::add(std::string_view html, bool is_chart) {
  if (!is_chart) close_charts();
  if (is_chart && !in_charts_) body_ += "<section class=\"charts\">\n";
  in_charts_ = is_chart;
  body_ += html;
  return *this;
}

void Document::close_charts() {
  if (in_charts_) body_ += "</section>\n";
  in_charts_ = false;
}

void Document::use(const std::string& style, const std::string& module) {
  styles_ += style;
  modules_.push_back(module);
}

std::string Document::html() const {
  std::string source =
      command_.empty() ? "" : "<section><h2>Made by</h2>\n" + command_html(command_) + "</section>\n";
  std::string files;
  for (const Link& l : links_)
    files += fill("<li><a href=\"{}\">{}</a>{!}</li>\n",
                  {l.target, l.text.empty() ? l.target : l.text,
                   l.note.empty() ? "" : fill(" <span>{}</span>", {l.note})});
  if (!files.empty())
    source += "<section><h2>Files</h2>\n<ul class=\"links\">\n" + files + "</ul></section>\n";
  if (!reading_.empty())
    source = "<section><details><summary><h2>How to read this page</h2></summary><div class=\"texts\">\n" +
             reading_ + "</div></details></section>\n" + source;
  const std::string texts = texts_.empty() ? "" : "<div class=\"texts\">\n" + texts_ + "</div>\n";
  std::string numbers = numbers_.empty() ? "" : "<dl class=\"numbers\">\n" + numbers_ + "</dl>\n";
  std::string head = purpose_.empty() ? "" : fill("<p class=\"purpose\">{}</p>", {purpose_});
  if (of_run_) {
    head = numbers + (summary_ + purpose_ == ""
                          ? ""
                          : fill("<p class=\"lead\"><b>Whole run</b> {} {}</p>\n", {summary_, purpose_}));
    numbers = "";
    source = tab_html("Run", source);
  } else if (!summary_.empty()) {
    head = fill("<p class=\"lead\">{}</p>\n", {summary_}) + head;
  }
  return filled(io::embedded_file("page.html"),
                {{"title", render::escape_markup(title_)},
                 {"verdict", verdict_},
                 {"purpose", head},
                 {"noscript", of_run_              ? kNoScript
                              : view_data_.empty() ? ""
                                                   : kNoScriptView},
                 {"style", styles_},
                 {"layout", view_data_.empty() ? "" : " class=\"wide\""},
                 {"frames", framing_ ? "; frame-src file: 'self'" : ""},
                 {"body", texts + numbers + body_ + (in_charts_ ? "</section>\n" : "") +
                              (tab_.empty() ? "" : "</div>\n") + source},
                 {"footer", render::escape_markup(footer_)},
                 {"data", script_safe("{\"frames\":" + frames_ + ",\"charts\":[" + charts_ + "]}")},
                 {"scene_data", view_data_},
                 {"library", libraries_},
                 {"script", script_of(modules_)}});
}

std::vector<std::string> Document::written() const {
  std::vector<std::string> out = {"index.html"};
  for (const auto& [name, bytes] : files_) out.push_back(name);
  return out;
}

void Document::write(const Folder& folder) const {
  for (const auto& [name, bytes] : files_) write_file(std::string(folder) + "/" + name, bytes);
  io::write_text(std::string(folder) + "/index.html", html());
}

}  // namespace lrb::report
