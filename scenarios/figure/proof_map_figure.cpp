#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "scenarios/figure/figure.hpp"
#include "scenarios/frames/proof_map.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::figure {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using frames::Argument;
using frames::MapCell;

/// Returns a share in per cent with two digits, without exponent.
std::string share_text(double share) {
  const double percent = 100 * share;
  std::ostringstream out;
  const int digits = percent >= 1 ? 1 : 1 - static_cast<int>(std::floor(std::log10(percent)));
  out << std::fixed << std::setprecision(digits) << percent;
  return (share < 1 ? out.str() : "100") + " %";
}

/// Returns the point of `to` at the place that `x` has in `from`.
Vector2d moved(const Vector2d& x, const AlignedBox2d& from, const AlignedBox2d& to) {
  return to.min() + (x - from.min()).cwiseQuotient(from.sizes()).cwiseProduct(to.sizes());
}

AlignedBox2d square(const Vector2d& corner, double side) {
  return {corner, corner + Vector2d(side, side)};
}

class MapFigure {
 public:
  MapFigure(const frames::RecordedRun& recorded, std::size_t step, frames::ProofMap map,
            const render::Style& style, const FigureSpec& figure)
      : recorded_(recorded),
        step_(recorded.trace->steps[step]),
        map_(std::move(map)),
        style_(style),
        figure_(figure),
        all_(static_cast<double>(map_.size[0]) * map_.size[1]) {
    arrange();
  }

  double height() const { return height_; }

  std::string caption() const {
    return "Proof map of step " + std::to_string(step_.index) + " of " + recorded_.title +
           ": all pairs of a face of A (down) and a face of B (across), in the order of their trees. Each "
           "rectangle was decided by one test; together they tile the square, so no pair was missed.";
  }

  void paint(render::Canvas& canvas, double dpi) const {
    for (const std::size_t side : {0, 1})
      write(canvas, {0, (0.5 + static_cast<double>(side)) * line()},
            (side == 0 ? "\u2193 " : "\u2192 ") + render::group_digits(map_.size[side]) +
                (recorded_.reps[0]->dim() == 3 ? " triangles of " : " segments of ") +
                (side == 0 ? "A" : "B") + ", in the order of its tree");
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      const auto& [place, part] = squares_[i];
      const double per_point = dpi / render::kPointsPerInch;
      const int size = static_cast<int>(std::lround(place.sizes().x() * per_point));
      canvas.picture(frames::pixels_of(map_, style_, part, size, 0.25 * per_point), place);
      canvas.stroke(render::corners(place), true, {style_.ink, figure_.line_width, 0});
      if (i > 0) paint_frame(canvas, i);
    }
    if (figure_.legend) paint_legend(canvas);
  }

 private:
  static constexpr double kGap = 6;

  struct Square {
    AlignedBox2d place, part;  ///< on paper; of the unit square, x across, y down
  };

  double line() const { return 1.35 * figure_.font_size; }

  void write(render::Canvas& canvas, const Vector2d& at, const std::string& text, bool bold = false,
             render::Align align = render::Align::left) const {
    canvas.text({at, text, render::kHeightOfFont * figure_.font_size, bold, style_.ink, align, style_.paper});
  }

  /// One square, and for bodies of many faces one or two beside it that enlarge the contact.
  void arrange() {
    constexpr double kShown = 40;  // simplices along a side of the last square
    const double rim = 0.5 * figure_.line_width, top = 2.2 * line(), width = figure_.width - 2 * rim,
                 last = kShown / std::max(map_.size[0], map_.size[1]);
    const int zooms = last > 0.25 ? 0 : last > 0.05 ? 1 : 2;
    const double small = (width - std::max(zooms, 1) * kGap) / (zooms + 1),
                 large = zooms == 0 ? width : zooms * (small + kGap) - kGap;
    squares_.push_back({square({rim, top}, large), square({0, 0}, 1)});
    for (int i = 0; i < zooms; ++i)
      squares_.push_back({square({rim + large + kGap, top + i * (small + kGap)}, small),
                          busiest(squares_.back().part, std::pow(last, (i + 1.0) / zooms))});
    height_ = top + large + kGap;
    rows_ = static_cast<std::size_t>(
        std::count_if(map_.pairs.begin(), map_.pairs.end(), [](std::uint64_t n) { return n > 0; }));
    if (figure_.legend) height_ += (static_cast<double>(rows_) + 1.3) * line();
  }

  /// Returns the square of this side in `whole` with the most contacts; without contacts, with the most pairs
  /// that were tested, or the smallest cells.
  AlignedBox2d busiest(const AlignedBox2d& whole, double side) const {
    std::vector<Vector2d> points;
    const auto rank = [](const MapCell& c) {
      return c.argument == Argument::contact || c.argument == Argument::tolerance ? -1.0
             : c.is_upon()                                                        ? 0.0
                           : static_cast<double>(c.pairs());
    };
    double least = all_ + 1;
    for (const MapCell& c : map_.cells) {
      const Vector2d at((c.low[1] + c.high[1]) / (2.0 * map_.size[1]),
                        (c.low[0] + c.high[0]) / (2.0 * map_.size[0]));
      if (!whole.contains(at) || rank(c) > least) continue;
      if (rank(c) < least) points.clear();
      least = rank(c);
      points.push_back(at);
    }
    constexpr std::size_t kTried = 400;
    AlignedBox2d best = square(whole.center() - Vector2d(side, side) / 2, side);
    std::ptrdiff_t most = 0;
    for (std::size_t i = 0; i < points.size(); i += points.size() / kTried + 1) {
      const Vector2d half(side / 2, side / 2);
      const AlignedBox2d box =
          square(points[i].cwiseMax(whole.min() + half).cwiseMin(whole.max() - half) - half, side);
      const auto inside =
          std::count_if(points.begin(), points.end(), [&](const Vector2d& p) { return box.contains(p); });
      if (inside > most) most = inside, best = box;
    }
    return best;
  }

  /// Marks in a square the part that the next one, to the right of it or below, enlarges.
  void paint_frame(render::Canvas& canvas, std::size_t i) const {
    const auto& [place, part] = squares_[i - 1];
    const AlignedBox2d& to = squares_[i].place;
    const AlignedBox2d frame(moved(squares_[i].part.min(), part, place),
                             moved(squares_[i].part.max(), part, place));
    const Vector2d from = i == 1 ? Vector2d(frame.max().x(), frame.min().y())
                                 : Vector2d(frame.min().x(), frame.max().y()),
                   end = i == 1 ? Vector2d(to.min().x(), to.max().y()) : Vector2d(to.max().x(), to.min().y());
    for (const render::Pen& pen : {render::Pen{style_.paper, 3 * figure_.line_width, 0},
                                   render::Pen{style_.ink, figure_.line_width, 0}}) {
      canvas.stroke(render::corners(frame), true, pen);
      canvas.strokes({{from, to.min()}, {frame.max(), end}}, pen);
    }
    write(canvas, to.min() + Vector2d(0.4, 0.6) * figure_.font_size,
          "\u00d7" + render::short_number(std::round(1 / squares_[i].part.sizes().x())), true);
  }

  void paint_legend(render::Canvas& canvas) const {
    double y = height_ - (static_cast<double>(rows_) + 0.8) * line();
    const double swatch = 2.2 * figure_.font_size, half = 0.38 * figure_.font_size;
    const auto row = [&](const std::string& name, double pairs, bool bold) {
      write(canvas, {swatch + half, y}, name, bold);
      write(canvas, {figure_.width - 7.5 * figure_.font_size, y},
            render::group_digits(static_cast<std::uint64_t>(pairs)), bold, render::Align::right);
      write(canvas, {figure_.width, y}, share_text(pairs / all_), bold, render::Align::right);
      y += line();
    };
    for (std::size_t i = 0; i < frames::kArguments; ++i) {
      if (map_.pairs[i] == 0) continue;
      const auto argument = static_cast<Argument>(i);
      const int steps = frames::look_of(argument).pale > 0 ? 6 : 1;  // from the colour of the largest cells
      for (int k = 0; k < steps; ++k)
        canvas.fill({render::corners({Vector2d(swatch * k / steps, y - half),
                                      Vector2d(swatch * (k + 1) / steps, y + half)})},
                    frames::colour_of(map_, style_, argument, std::pow(all_, 1 - (k + 0.5) / steps)));
      row(frames::argument_name(argument, recorded_, step_), static_cast<double>(map_.pairs[i]), false);
    }
    canvas.stroke({{0, y - 0.5 * line()}, {figure_.width, y - 0.5 * line()}}, false,
                  {style_.ink, figure_.line_width, 0});
    y += 0.2 * line();
    row("all pairs", all_, true);
  }

  const frames::RecordedRun& recorded_;
  const trace::Step& step_;
  frames::ProofMap map_;
  const render::Style& style_;
  const FigureSpec& figure_;
  double all_, height_ = 0;
  std::vector<Square> squares_;
  std::size_t rows_ = 0;  ///< of the legend
};

}  // namespace

Figure draw_proof_map(const frames::RecordedRun& recorded, const pictures::Look& look,
                      const FigureSpec& figure) {
  const trace::Trace& trace = *recorded.trace;
  if (trace.header.engine.empty() && trace.header.level == EventLevel::faces)
    throw InputError(
        "--proof-map: expected pairs of tree nodes, found none in the run; record it with --events all");
  const std::vector<std::uint32_t>& wanted = figure.choice.numbers;
  std::optional<frames::ProofMap> map;
  std::size_t step = trace.steps.size();
  while (!map && step-- > 0)
    if (wanted.empty() || wanted.front() == trace.steps[step].index) map = frames::proof_map(recorded, step);
  if (!map || map->size[0] == 0 || map->size[1] == 0)
    throw InputError(
        "--proof-map: expected a step with a traversal of two trees, found none; choose another by --steps");
  const double dpi = figure.dpi > 0 ? figure.dpi : 600;
  const MapFigure job(recorded, step, std::move(*map), render::style_of(look.style), figure);
  const render::PaperPage page{figure.width, job.height(), look.paper(), recorded.title,
                               "lrbscope " + trace.header.lrbscope};
  return {figure_file(figure.format, dpi, page, [&](render::Canvas& canvas) { job.paint(canvas, dpi); }),
          job.caption(),
          1,
          {}};
}

}  // namespace lrb::figure
