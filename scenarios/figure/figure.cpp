#include "scenarios/figure/figure.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/canvas.hpp"
#include "render/paint_list.hpp"
#include "render/pictures/panel.hpp"
#include "render/vector_faces.hpp"
#include "scenarios/figure/figure_layout.hpp"
#include "scenarios/figure/figure_panels.hpp"
#include "scenarios/figure/figure_tex.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/frames/framing.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::figure {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using View = render::FrameSpec::View;

/// Returns a caption without its redundant parts.
std::string shortened(std::string text) {
  const std::string none = ": 0 intersecting pairs of faces";
  if (text.ends_with(none)) text.resize(text.size() - none.size());
  return text;
}

/// Returns the frames' spec with widths in points: a thin line, of width 1, gets the figure's line width.
render::FrameSpec in_points(render::FrameSpec frames, const FigureSpec& figure) {
  // The figure sets the line width, whatever the style.
  frames.dpi = figure.line_width * render::FrameSpec::kScreenDpi / style_of(frames.style).weight;
  if (frames.views.empty()) frames.views.emplace_back();
  return frames;
}

class FigureJob {
 public:
  FigureJob(const run::RecordedRun& recorded, const render::FrameSpec& frames, const FigureSpec& figure)
      : recorded_(recorded),
        figure_(figure),
        frames_(in_points(frames, figure)),
        dpi_(figure.dpi > 0 ? figure.dpi : default_dpi(figure.format)),
        chosen_(choose(recorded, figure.choice)),
        framing_(run::frame_sequence(recorded, frames_)),
        state_(in_common_range(), frames_, false) {}

  Figure draw(const run::ProgressReport& progress) {
    arrange();
    if (figure_.choice.by == Choice::By::changes && leave_out_alike(progress)) arrange();
    Figure out;
    out.panels = captions_.size();
    if (!chosen_.left_out.empty()) out.notes.push_back(chosen_.left_out);
    if (!flat() && figure_.format != FigureSpec::Format::png) find_vector_faces(out.notes, progress);
    out.caption = caption();
    const auto paint = [&](render::Canvas& canvas) {
      if (figure_.tex.empty()) return paint_all(canvas, progress);
      TextOverlay overlay(canvas);
      paint_all(overlay, progress);
      out.tex = overlay.tex(figure_.tex, figure_.width, layout_.height, figure_.font_size);
    };
    const std::optional<render::Rgba> background = frames_.paper();
    const std::string program = "lrbscope " + recorded_.trace->header.lrbscope;
    const render::PaperPage page{figure_.width, layout_.height, background, recorded_.title, program};
    switch (figure_.format) {
      case FigureSpec::Format::pdf:
        out.bytes = render::paint_pdf(page, paint);
        break;
      case FigureSpec::Format::svg: {
        render::SvgCanvas canvas(render::SvgCanvas::Texts::outlines);
        paint(canvas);
        out.bytes = render::svg_file(
            canvas, {page.width, page.height, kPointsPerScreenPixel, page.title, background, true});
        break;
      }
      case FigureSpec::Format::png: {
        const auto png =
            render::encode_png(render::paint_pixels(page, dpi_, paint),
                               {{{"Software", program}, {"lrbscope:scenario", recorded_.title}}, dpi_});
        out.bytes.assign(png.begin(), png.end());
        break;
      }
    }
    return out;
  }

 private:
  static constexpr double kPointsPerScreenPixel = 0.75;

  const render::Style& style() const { return style_of(frames_.style); }
  bool flat() const { return framing_.dim == 2; }
  std::size_t moments() const { return chosen_.events.size(); }

  LayoutOptions options() const {
    constexpr double kWidest =
        3;  // half the width of the widest lines, contacts with their halo, in thin lines
    LayoutOptions o;
    o.width = figure_.width;
    o.font_size = figure_.font_size;
    o.margin = kWidest * figure_.line_width;
    o.grid = flat() && figure_.format != FigureSpec::Format::png ? 0 : render::kPointsPerInch / dpi_;
    o.columns = figure_.columns;
    return o;
  }

  /// Returns the run with one colour scale for all panels, so that a single bar is valid for each.
  run::RecordedRun in_common_range() {
    run::RecordedRun out = recorded_;
    if (out.value_range || !shows_values()) return out;
    run::FrameState state(recorded_, frames_, false);
    std::optional<std::array<double, 2>>& range = out.value_range;
    for (const trace::EventId event : chosen_.events) {
      state.seek(event);
      const render::Scene scene = state.scene();
      if (!scene.scale) continue;
      if (!range) range = {scene.scale->low, scene.scale->high};
      range = {std::min((*range)[0], scene.scale->low), std::max((*range)[1], scene.scale->high)};
    }
    return out;
  }

  bool shows_values() const {
    using ColourBy = render::FrameSpec::ColourBy;
    const ColourBy by = frames_.colour_by;
    return by != ColourBy::kind && by != ColourBy::layer && by != ColourBy::region;
  }

  /// Returns true if a panel's content extends beyond the view, as in a close-up.
  static bool runs_over(const Block& block) {
    constexpr double kRim = 1e-3 * kViewSide;
    return std::any_of(block.seen.begin(), block.seen.end(), [](const AlignedBox2d& seen) {
      return seen.min().minCoeff() < kRim || seen.max().maxCoeff() > kViewSide - kRim;
    });
  }

  render::Camera camera(const View& view, std::size_t moment) const {
    const double progress =
        moments() > 1 ? static_cast<double>(moment) / (static_cast<double>(moments()) - 1) : 0;
    return run::camera_for(view, framing_, kViewSide, kViewSide, progress);
  }

  render::Scene scene(const View& view, std::size_t moment) {
    state_.seek(chosen_.events[moment]);
    render::Scene scene = state_.scene(view.wrapper, true);
    const auto least = static_cast<float>(kHairline);
    for (render::DrawLine& l : scene.list.lines) l.width = std::max(l.width, least);
    for (render::EdgeStyle& e : scene.list.edge_styles) e.width = std::max(e.width, least);
    return scene;
  }

  std::string caption() const { return run::caption_of(recorded_, captions_); }

  void arrange() {
    survey();
    layout_ = lay_out(blocks_, figure_.legend ? key_ : std::vector<render::LegendItem>(),
                      figure_.legend ? bar_ : std::nullopt, figure_.caption ? caption() : "", options());
  }

  // ---- panels that look alike

  /// Removes states whose panels cannot be distinguished in print from those of the state before; the first
  /// and the last state stay. Returns true if any were removed.
  bool leave_out_alike(const run::ProgressReport& progress) {
    std::vector<std::vector<render::Image>> seen(moments());  // by state: its panels, in order of the views
    std::size_t done = 0;
    for (std::size_t b = 0; b < panels_.size(); ++b)
      for (const auto& [view, moment] : panels_[b]) {
        progress("compare", done++, captions_.size());
        seen[moment].push_back(in_print(*view, moment, layout_.blocks[b].scale));
      }
    std::vector<trace::EventId> kept;
    std::size_t last_kept = 0;
    for (std::size_t i = 0; i < moments(); ++i) {
      if (i > 0 && alike(seen[last_kept], seen[i])) {
        if (i + 1 < moments() || kept.size() == 1) continue;
        kept.pop_back();
      }
      kept.push_back(chosen_.events[i]);
      last_kept = i;
    }
    const std::size_t removed = moments() - kept.size();
    if (removed == 0) return false;
    chosen_.left_out = render::counted(removed, "state is", "states are") +
                       " omitted: in grey and at this width its panel would look like the one before; "
                       "--faces, --steps and --events show any state";
    chosen_.events = std::move(kept);
    return true;
  }

  static bool alike(const std::vector<render::Image>& a, const std::vector<render::Image>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const render::Image& x, const render::Image& y) { return alike_in_grey(x, y); });
  }

  /// Draws the whole view of a state as large as in the figure, with the resolution of the eye.
  render::Image in_print(const View& view, std::size_t moment, double scale) {
    const double pixel = render::kPointsPerInch / kEyeDpi,
                 side = pixel * std::ceil(kViewSide * scale / pixel);
    PanelPlace place;
    place.box = AlignedBox2d(Vector2d(0, 0), Vector2d(side, side));
    place.seen_from = Vector2d(options().margin, options().margin) / scale;
    const render::Scene shown = scene(view, moment);
    return render::paint_pixels({side, side, render::kWhite, {}, {}}, kEyeDpi, [&](render::Canvas& canvas) {
      flat() ? paint_flat(canvas, shown.list, camera(view, moment), place, scale)
             : paint_deep(canvas, shown.list, camera(view, moment), place, scale, kEyeDpi);
    });
  }

  /// Determines the content and size of each panel, and the entries of the common legend.
  void survey() {
    panels_.clear(), blocks_.clear(), captions_.clear(), key_.clear();
    for (const View& view : frames_.views) {
      if (blocks_.empty() || !figure_.contact_sheet) blocks_.emplace_back(), panels_.emplace_back();
      for (std::size_t i = 0; i < moments(); ++i) {
        const render::Scene shown = scene(view, i);
        if (!shows_anything(view)) continue;
        run::merge_key(key_, shown.key);
        if (shown.scale) bar_ = shown.scale;
        blocks_.back().seen.push_back(seen_box(shown.list, camera(view, i)));
        const std::string text = shortened(state_.short_caption());
        captions_.push_back(view.title.empty()      ? text
                            : figure_.contact_sheet ? view.title
                                                    : view.title + ", " + text);
        panels_.back().push_back({&view, i});
      }
      if (panels_.back().empty()) blocks_.pop_back(), panels_.pop_back();
    }
    if (blocks_.empty()) throw InputError("figure of contacts: expected a panel with a contact, found none");
    letter();
  }

  /// Returns false for a close-up of a contact without contacts, beside other views.
  bool shows_anything(const View& view) const {
    return view.camera != render::FrameSpec::Camera::contact || frames_.views.size() == 1 ||
           state_.in_contact();
  }

  void letter() {
    const bool letters = captions_.size() > 1;
    if (!letters && !figure_.titles) return;
    std::size_t panel = 0;
    for (Block& block : blocks_)
      for (std::size_t i = 0; i < block.seen.size(); ++i, ++panel)
        block.texts.push_back((letters ? render::panel_letter(panel) : "") +
                              (letters && figure_.titles ? " " : "") +
                              (figure_.titles ? captions_[panel] : ""));
  }

  void paint_all(render::Canvas& canvas, const run::ProgressReport& progress) {
    std::size_t panel = 0;
    for (std::size_t b = 0; b < panels_.size(); ++b) {
      const BlockLayout& block = layout_.blocks[b];
      for (std::size_t i = 0; i < block.panels.size(); ++i, ++panel) {
        progress("draw", panel, captions_.size());
        const PanelPlace& place = block.panels[i];
        const View& view = *panels_[b][i].view;
        const std::size_t moment = panels_[b][i].moment;
        const render::Scene shown = scene(view, moment);
        flat() ? paint_flat(canvas, shown.list, camera(view, moment), place, block.scale)
               : paint_deep(canvas, shown.list, camera(view, moment), place, block.scale, dpi_,
                            visible_.empty() ? nullptr : &visible_[panel]);
        if (runs_over(blocks_[b]))
          canvas.stroke(render::corners(place.box), true, {style().faint, kHairline, 0});
        double y = place.box.max().y() + 0.65 * figure_.font_size;
        for (const std::string& line : place.lines) {
          canvas.text({{place.box.center().x(), y},
                       line,
                       layout_.text_height,
                       false,
                       style().ink,
                       render::Align::centre});
          y += 1.3 * figure_.font_size;
        }
      }
    }
    paint_key(canvas, layout_, figure_.legend ? key_ : std::vector<render::LegendItem>(),
              figure_.legend ? bar_ : std::nullopt, style());
    for (const auto& [y, line] : layout_.caption)
      canvas.text({{0, y}, line, layout_.text_height, false, style().ink});
  }

  void paint_flat(render::Canvas& canvas, const render::DrawList& list, const render::Camera& camera,
                  const PanelPlace& place, double scale) const {
    const double side = kViewSide * scale, margin = options().margin;
    const render::Projection projection(camera, side, side, render::bounds(list));
    canvas.begin_clip(place.box);
    render::paint_flat(canvas, list, projection,
                       place.box.min() + Vector2d(margin, margin) - place.seen_from * scale);
    canvas.end_clip();
  }

  /// The part of a view that a panel shows.
  struct DeepView {
    render::Camera camera;
    Vector2d paper;         ///< size of the camera's picture, points
    Eigen::Vector2i drawn;  ///< the same, pixels
    Eigen::Vector2i from;   ///< pixel of the picture at the corner of the panel's box
    Vector2d origin;        ///< corner of the picture on the page
    double pixel;           ///< points
  };

  DeepView deep_view(const render::Camera& whole, const PanelPlace& place, double scale, double dpi) const {
    DeepView out;
    out.pixel = render::kPointsPerInch / dpi;
    const double pixel = out.pixel, margin = options().margin, centre = 0.5 * kViewSide * scale;
    const Vector2d low =
        place.seen_from * scale - Vector2d(margin, margin);  // of the box, in the view, points
    // The central part of the view that contains the box, with a margin of one pixel on each side.
    const Vector2d reach =
        (low.array() - centre).abs().max((low + place.box.sizes()).array() - centre) + 2 * pixel;
    out.drawn = (2 * reach / pixel).array().ceil().cast<int>();
    out.paper = out.drawn.cast<double>() * pixel;
    out.camera = central_part(whole, out.paper.y() / scale);
    out.from = ((low - Vector2d(centre, centre) + 0.5 * out.paper) / pixel).array().round().cast<int>();
    out.origin = place.box.min() - out.from.cast<double>() * pixel;
    return out;
  }

  /// Finds the visible faces of all panels, if none has too many.
  void find_vector_faces(std::vector<std::string>& notes, const run::ProgressReport& progress) {
    std::size_t panel = 0;
    for (std::size_t b = 0; b < panels_.size(); ++b)
      for (std::size_t i = 0; i < panels_[b].size(); ++i, ++panel) {
        progress("find visible faces", panel, captions_.size());
        const auto [view, moment] = panels_[b][i];
        const render::DrawList list = scene(*view, moment).list;
        const DeepView deep =
            deep_view(camera(*view, moment), layout_.blocks[b].panels[i], layout_.blocks[b].scale, dpi_);
        const render::DepthImage depths =
            rasterizer_.depths(list, deep.camera, deep.drawn.x(), deep.drawn.y());
        auto visible = render::visible_faces(list, projection(deep, list), depths);
        if (visible && visible->size() <= figure_.vector_faces) {
          visible_.push_back(std::move(*visible));
          continue;
        }
        visible_.clear();
        if (visible)
          notes.push_back("faces are an image of " + render::short_number(dpi_) + " dpi: " +
                          (captions_.size() > 1 ? "panel " + render::panel_letter(panel) + " has " : "") +
                          render::counted(visible->size(), "visible face", "visible faces") +
                          ", more than --vector-faces " + std::to_string(figure_.vector_faces));
        return;
      }
  }

  static render::Projection projection(const DeepView& deep, const render::DrawList& list) {
    return {deep.camera, deep.paper.x(), deep.paper.y(), render::bounds(list)};
  }

  /// Paints the faces `visible` as vector graphics, or without them all faces as pixels of resolution `dpi`,
  /// with whole pixels in the panel's box. Paints lines and texts over them.
  void paint_deep(render::Canvas& canvas, const render::DrawList& list, const render::Camera& whole,
                  const PanelPlace& place, double scale, double dpi,
                  const std::vector<std::uint32_t>* visible = nullptr) {
    const DeepView deep = deep_view(whole, place, scale, dpi);
    const render::DepthImage depths = rasterizer_.depths(list, deep.camera, deep.drawn.x(), deep.drawn.y());
    const render::Projection on_paper = projection(deep, list);
    if (visible == nullptr) canvas.picture(pixels(list, deep, place), place.box);
    canvas.begin_clip(place.box);
    if (visible != nullptr) {
      const render::Lighting lighting;
      const render::FaceLooks looks(list, on_paper, 1, lighting, true);
      render::paint_faces(canvas, list, render::painting_order(list, on_paper, looks, *visible), looks,
                          deep.origin);
      render::paint_visible_lines(canvas, list, on_paper, depths, deep.origin);
    }
    render::paint_over(canvas, list, on_paper, depths, deep.origin);
    canvas.end_clip();
  }

  render::Image pixels(const render::DrawList& list, const DeepView& deep, const PanelPlace& place) {
    const Eigen::Vector2i size = (place.box.sizes() / deep.pixel).array().round().cast<int>();
    render::RasterOptions raster;
    raster.width = deep.drawn.x(), raster.height = deep.drawn.y();
    raster.supersample = frames_.supersampling;
    raster.unit = 1 / deep.pixel;
    raster.labels = false;
    raster.even_edges = true;
    raster.background = frames_.paper();
    const render::Image picture = rasterizer_.draw(render::under_lines(list), deep.camera, raster);
    render::Image part(size.x(), size.y(), render::kTransparent);
    part.paste(picture, -deep.from.x(), -deep.from.y());
    return part;
  }

  const run::RecordedRun& recorded_;
  const FigureSpec& figure_;
  render::FrameSpec frames_;
  double dpi_;
  Chosen chosen_;
  run::Framing framing_;
  run::FrameState state_;
  render::Rasterizer rasterizer_;
  struct ShownState {
    const View* view;
    std::size_t moment;
  };
  std::vector<Block> blocks_;                    ///< one for each view with content, or one for all
  std::vector<std::vector<ShownState>> panels_;  ///< by block
  std::vector<std::string> captions_;            ///< (panels) description of each
  std::vector<render::LegendItem> key_;
  std::optional<render::ScaleBar> bar_;
  FigureLayout layout_;
  std::vector<std::vector<std::uint32_t>>
      visible_;  ///< (panels) faces to draw as vector graphics; empty: image
};

}  // namespace

FigureSpec::Format format_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".pdf") return FigureSpec::Format::pdf;
  if (ending == ".svg") return FigureSpec::Format::svg;
  if (ending == ".png") return FigureSpec::Format::png;
  throw InputError(path + ": a figure is a .pdf, an .svg or a .png file: end its name in one of these");
}

double default_dpi(FigureSpec::Format format) {
  return format == FigureSpec::Format::png ? 300 : 600;
}

Figure draw_figure(const run::RecordedRun& recorded, const render::FrameSpec& frames,
                   const FigureSpec& figure, const run::ProgressReport& progress) {
  return FigureJob(recorded, frames, figure).draw(progress);
}

}  // namespace lrb::figure
