#include "scenarios/report/page/comparison.hpp"

#include "render/markup.hpp"

namespace lrb::report {
namespace {

constexpr const char* kKinds[] = {"expected", "actual", "difference"};
constexpr const char* kNames[] = {"Approved", "Found", "Difference, 16 times"};

std::string figure_html(const PageComparison& c, std::size_t kind) {
  if (c.data_uris[kind].empty()) return {};
  std::string out =
      "<figure class=\"" + std::string(kKinds[kind]) + "\"><figcaption><b>" + kNames[kind] + "</b>";
  if (kind < c.captions.size() && !c.captions[kind].empty())
    out += " " + render::escape_markup(c.captions[kind]);
  return out + "</figcaption><img alt=\"" + render::escape_markup(c.title + ", " + kKinds[kind]) +
         "\" src=\"" + render::escape_markup(c.data_uris[kind]) + "\"></figure>";
}

std::string modes_html(const PageComparison& c) {
  if (c.data_uris[0].empty() || c.data_uris[1].empty()) return {};
  return "<div class=\"modes\" role=\"group\" aria-label=\"How to compare\">"
         "<button type=\"button\" data-mode=\"side\" aria-pressed=\"true\">Side by side</button>"
         "<button type=\"button\" data-mode=\"swipe\" aria-pressed=\"false\">Swipe</button>"
         "<button type=\"button\" data-mode=\"difference\" aria-pressed=\"false\">Difference</button>"
         "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Swipe: approved on the left, "
         "found on the right\"></div>\n";
}

}  // namespace

std::string comparisons_html(const std::vector<PageComparison>& comparisons) {
  std::string out;
  for (const PageComparison& c : comparisons) {
    out += "<section class=\"comparison\" id=\"" + render::escape_markup(c.id) + "\"><h2>" +
           render::escape_markup(c.title) + " <span class=\"outcome " +
           (c.passed ? "passed\">passed" : "failed\">failed") + "</span></h2>\n";
    out += "<p class=\"finding\">" + render::escape_markup(c.text) + "</p>\n" + modes_html(c);
    out += "<div class=\"pictures\" data-mode=\"side\">";
    for (std::size_t kind = 0; kind < c.data_uris.size(); ++kind) out += figure_html(c, kind);
    out += "</div>\n";
    if (!c.command.empty())
      out += "<p class=\"note\">If this is how it should be:</p>\n<pre class=\"command\"><code>" +
             render::escape_markup(c.command) + "</code></pre>\n";
    out += "</section>\n";
  }
  return out;
}

}  // namespace lrb::report
