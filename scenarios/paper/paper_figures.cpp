#include "scenarios/paper/paper_figures.hpp"

#include <algorithm>
#include <map>

#include <lrbscope/core/strings.hpp>

namespace lrb::paper {
namespace {

constexpr double kBinWidth = 250;  // comparisons

// Okabe and Ito's colours, which people with any colour vision tell apart; dash and point types are told
// apart in grey, too.
constexpr const char* kColours[] = {"#0072B2", "#E69F00", "#009E73", "#D55E00",
                                    "#56B4E9", "#CC79A7", "#000000"};

}  // namespace

report::Gnuplot figure_3_1(std::span<const ObjectRow> rows) {
  constexpr double kBeside = 1.06;  // published bars stand to the right of ours by this factor
  const auto bar = [](double size, double average, double min, double max) {
    return io::fixed_text(size) + " " + io::fixed_text(average) + " " + io::fixed_text(min) + " " +
           io::fixed_text(max);
  };
  std::vector<std::string> measured, as_published, names;
  for (const ObjectRow& row : rows) {
    const Spread& s = row.recursions[kPaper].comparisons;
    measured.push_back(bar(row.total_faces, s.average, s.min, s.max));
    double top = s.max;
    if (const PublishedRow* p = published(row.object)) {
      as_published.push_back(bar(row.total_faces * kBeside, p->average, p->min, p->max));
      top = std::max(top, p->max);
    }
    names.push_back(io::fixed_text(row.total_faces) + " " + io::fixed_text(top) + " " +
                    report::gnuplot_data_text(row.object));
  }
  report::Gnuplot g;
  g.add_data("measured", measured);
  g.add_data("published", as_published);
  g.add_data("names", names);
  g.script += R"(set logscale x
set xrange [80:90000]
set yrange [0:*]
set offsets 0, 0, graph 0.05, 0
set xlabel 'size of the object that A meets: real and pseudo faces'
set ylabel 'face comparisons in a time step'
set key top left reverse Left
set grid y lc rgb '#dddddd'
set border 3
set tics nomirror out
plot $measured using 1:2:3:4 with yerrorbars lw 1.5 pt 7 ps 0.6 lc rgb '#0072B2' title 'measured: average, minimum, maximum', \
     $measured using 1:2 with lines lw 1.5 lc rgb '#0072B2' notitle, \
     $published using 1:2:3:4 with yerrorbars lw 1.5 pt 5 ps 0.6 lc rgb '#D55E00' title 'published', \
     $published using 1:2 with lines dt 2 lw 1.5 lc rgb '#D55E00' notitle, \
     $names using 1:2:3 with labels offset 0.3, 0.7 tc rgb '#555555' notitle
)";
  return g;
}

report::Gnuplot figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps) {
  report::Gnuplot g;
  std::string plot = "plot ";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::map<std::uint64_t, int> bins;
    for (const ContactStep& s : steps)
      if (s.object == rows[i].object)
        ++bins[static_cast<std::uint64_t>(static_cast<double>(s.counts[kPaper].comparisons) / kBinWidth)];
    std::vector<std::string> points;
    const std::uint64_t last = bins.empty() ? 0 : bins.rbegin()->first;
    for (std::uint64_t b = 0; b <= last; ++b)
      points.push_back(io::fixed_text((static_cast<double>(b) + 0.5) * kBinWidth) + " " +
                       std::to_string(bins[b]));
    g.add_data("object_" + rows[i].object, points);
    plot += (i > 0 ? ", " : "") + std::string("$object_") + rows[i].object +
            " using 1:2 with lines lw 1.5 dt " + std::to_string(i % 5 + 1) + " lc rgb '" +
            kColours[i % std::size(kColours)] + "' title " +
            report::gnuplot_text(rows[i].object + ": " + std::to_string(rows[i].total_faces) + " faces");
  }
  g.script += "set xlabel 'face comparisons in a time step (bins of " + io::fixed_text(kBinWidth) + ")'\n";
  g.script += R"(set ylabel 'time steps'
set xrange [0:8000]
set yrange [0:*]
set key top right
set grid y lc rgb '#dddddd'
set border 3
set tics nomirror out
)" + plot + "\n";
  return g;
}

}  // namespace lrb::paper
