#include "scenarios/figure/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "render/canvas.hpp"
#include "render/face_look.hpp"
#include "render/pictures/panel.hpp"
#include "render/vector_faces.hpp"
#include "scenarios/figure/panel_painter.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/frames/framing.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::figure {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using View = pictures::FrameSpec::View;

/// Returns the frames' spec with widths in points: a thin line, of width 1, gets the figure's line width.
pictures::FrameSpec in_points(pictures::FrameSpec frames, const FigureSpec& figure) {
  // The figure sets the line width, whatever the style.
  frames.dpi = figure.line_width * pictures::FrameSpec::kScreenDpi / style_of(frames.style).weight;
  if (frames.views.empty()) frames.views.emplace_back();
  return frames;
}

class FigureJob {
 public:
  FigureJob(const frames::RecordedRun& recorded, const pictures::FrameSpec& frames, const FigureSpec& figure)
      : recorded_(recorded),
        figure_(figure),
        frames_(in_points(frames, figure)),
        dpi_(figure.dpi > 0 ? figure.dpi : default_dpi(figure.format)),
        chosen_(choose(recorded, figure.choice)),
        framing_(frames::frame_sequence(recorded, frames_)),
        state_(in_common_range(), frames_, false),
        painter_(frames_, framing_.dim, margin()) {
    for (const Callout& c : figure.callouts) check_target(c.option, c.target, recorded.reps);
    for (const Inset& i : figure.insets) check_target(i.option, i.target, recorded.reps);
    if (figure.occlusion && shows_values())
      throw InputError("--occlusion: would change the colours of --colour-by; omit one of them");
  }

  Figure draw(const record::ProgressReport& progress) {
    arrange();
    if (figure_.choice.by == Choice::By::changes && leave_out_alike(progress)) arrange();
    check_letters();
    reserve_space();
    Figure out;
    out.panels = captions_.size();
    if (!chosen_.left_out.empty()) out.notes.push_back(chosen_.left_out);
    if (!flat() && figure_.format != FigureSpec::Format::png) find_vector_faces(out.notes, progress);
    out.caption = caption();
    const std::string program = "lrbscope " + recorded_.trace->header.lrbscope;
    out.bytes = figure_file(figure_.format, dpi_,
                            {figure_.width, layout_.height, frames_.paper(), recorded_.title, program},
                            [&](render::Canvas& canvas) { paint_all(canvas, progress); });
    if (constexpr double kPage = 240 * kPointsPerMm; layout_.height > kPage)
      out.notes.push_back("the figure is " + length_text(layout_.height) +
                          " high, more than a page; use fewer panels or --views, or more --columns");
    for (std::size_t i = 0; i < figure_.callouts.size(); ++i)
      if (!called_out_.contains(i))
        out.notes.push_back(figure_.callouts[i].option + ": is outside of " +
                            (figure_.callouts[i].panel.empty() ? "all panels" : "its panel"));
    for (const std::string& letter : covered_)
      out.notes.push_back("callouts cover the bodies in panel (" + letter +
                          "); give it more room: fewer --columns, a larger --width, a shorter =TEXT");
    return out;
  }

 private:
  const render::Style& style() const { return style_of(frames_.style); }
  bool flat() const { return framing_.dim == 2; }
  std::size_t moments() const { return chosen_.events.size(); }

  /// Half the width of the widest lines, contacts with their halo.
  double margin() const {
    constexpr double kThinLines = 3;
    return kThinLines * figure_.line_width;
  }

  LayoutOptions options() const {
    LayoutOptions o;
    o.width = figure_.width;
    o.font_size = figure_.font_size;
    o.margin = margin();
    o.grid = flat() && figure_.format != FigureSpec::Format::png ? 0 : render::kPointsPerInch / dpi_;
    o.columns = figure_.columns;
    return o;
  }

  /// Returns the run with one colour scale for all panels, so that a single bar is valid for each.
  frames::RecordedRun in_common_range() {
    frames::RecordedRun out = recorded_;
    if (out.value_range || !shows_values()) return out;
    frames::FrameState state(recorded_, frames_, false);
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

  bool shows_values() const { return pictures::is_value(frames_.colour_by); }

  render::Camera camera(const View& view, std::size_t moment) const {
    const double progress =
        moments() > 1 ? static_cast<double>(moment) / (static_cast<double>(moments()) - 1) : 0;
    return pictures::camera_for(view, framing_, kViewSide, kViewSide, progress);
  }

  render::Projection projection(const render::DrawList& list, const View& view, std::size_t moment) const {
    return {camera(view, moment), kViewSide, kViewSide, render::bounds(list)};
  }

  render::Scene scene(const View& view, std::size_t moment) {
    state_.seek(chosen_.events[moment]);
    render::Scene scene = state_.scene(view.wrapper, true);
    const auto least = static_cast<float>(kHairline);
    for (render::DrawLine& l : scene.list.lines) l.width = std::max(l.width, least);
    for (render::EdgeStyle& e : scene.list.edge_styles) e.width = std::max(e.width, least);
    return scene;
  }

  std::string caption() const {
    std::vector<std::string> texts = captions_;
    for (const Piece& piece : pieces_)
      if (piece.inset != nullptr)
        texts[piece.panel] += " (inset: " + name_of(piece.inset->target, recorded_.reps.size()) + ", " +
                              render::short_number(std::round(10 * piece.magnification) / 10) +
                              " times as large)";
    return frames::caption_of(recorded_, texts);
  }

  void arrange() {
    survey();
    pieces_.clear();
    lay_out_all();
    if (figure_.caption && !figure_.insets.empty()) lay_out_all();  // the caption gives the magnifications
  }

  void lay_out_all() {
    layout_ = lay_out(blocks_, figure_.legend ? key_ : std::vector<render::LegendItem>(),
                      figure_.legend ? bar_ : std::nullopt, figure_.caption ? caption() : "", options());
    find_pieces();
  }

  // ---- insets and callouts

  static std::string letter_of(std::size_t panel) {
    const std::string text = render::panel_letter(panel);
    return text.substr(1, text.size() - 2);
  }

  void check_letters() const {
    const auto check = [this](const std::string& option, const std::string& letter) {
      for (std::size_t i = 0; i < captions_.size(); ++i)
        if (letter.empty() || letter == letter_of(i)) return;
      throw InputError(option + ": expected a panel of the figure, which has " +
                       (captions_.size() > 1 ? "a to " + letter_of(captions_.size() - 1) : "only a"));
    };
    for (const Callout& c : figure_.callouts) check(c.option, c.panel);
    for (const Inset& i : figure_.insets) check(i.option, i.panel);
  }

  const LrbRep& rep_of(const Target& target) const { return *recorded_.reps[target.body]; }
  /// Returns the pose of a target as drawn: exploded bodies show regions, with their lids, away from their
  /// places.
  Pose pose_of(const Target& target) const {
    Pose pose = state_.pose(static_cast<Side>(target.body));
    if (!(frames_.explode > 0) || target.kind == Target::Kind::contact) return pose;
    const LrbRep& rep = rep_of(target);
    pose.t += target.kind == Target::Kind::face
                  ? render::exploded_way(rep, pose, FaceId(target.number), frames_.explode)
                  : render::exploded_way(rep, pose, RegionId(target.number), frames_.explode);
    return pose;
  }

  /// Collects panels, each followed by its insets.
  void find_pieces() {
    pieces_.clear();
    std::size_t panel = 0;
    for (std::size_t b = 0; b < panels_.size(); ++b) {
      const BlockLayout& block = layout_.blocks[b];
      for (std::size_t i = 0; i < block.panels.size(); ++i, ++panel) {
        const PanelPlace& place = block.panels[i];
        const auto [view, moment] = panels_[b][i];
        pieces_.push_back({view, moment, b, panel, place, block.scale, nullptr, 1,
                           painter_.shown_part(place, block.scale)});
        for (std::size_t k = 0; k < place.insets.size(); ++k) add_inset(b, i, panel, k);
        const auto insets = pieces_.end() - static_cast<std::ptrdiff_t>(place.insets.size());
        uncross(insets[-1], {insets, pieces_.end()});
      }
    }
  }

  /// Adds an inset: the target with its surroundings, in a square. Its magnification is limited, so that its
  /// frame in the panel can be seen, and so that it shows more than the panel, of a large target the middle.
  void add_inset(std::size_t b, std::size_t i, std::size_t panel, std::size_t k) {
    constexpr double kFaceRoom = 4, kRoom = 1.7;  // sides of the square, in sizes of the target
    constexpr double kLeast = 2, kMax = 12;
    const BlockLayout& block = layout_.blocks[b];
    const auto& [inset, target] = inset_boxes_[panel][k];
    Piece piece{panels_[b][i].view, panels_[b][i].moment, b, panel, {}, 0, inset};
    piece.place.box = block.panels[i].insets[k];
    const double side = piece.place.box.sizes().x(),
                 room = inset->target.kind == Target::Kind::face ? kFaceRoom : kRoom,
                 exact = side / (std::max(target.sizes().maxCoeff(), 1e-9 * kViewSide) * block.scale);
    piece.magnification =
        inset->magnification > 0 ? inset->magnification : std::clamp(exact / room, kLeast, kMax);
    piece.scale = piece.magnification * block.scale;
    const Vector2d half = 0.5 * piece.place.box.sizes() / piece.scale;
    piece.shown = {target.center() - half, target.center() + half};
    piece.place.seen_from = piece.shown.min() + Vector2d::Constant(margin() / piece.scale);
    pieces_.push_back(std::move(piece));
  }

  static constexpr double kCoveringText = 0.1;  ///< share of a callout's text over content that is avoided

  double callout_radius() const { return std::max(1.0, 3 * figure_.line_width); }

  /// Adds the marks of a piece to its scene: the outline of an inset's target, outlines and points of
  /// callouts. Returns the callouts with their anchors in the view. A callout whose anchor is in an inset of
  /// the panel is in the inset, not in the panel.
  std::vector<std::pair<const Callout*, Vector2d>> add_marks(render::DrawList& list, const Piece& piece) {
    const render::Projection view = projection(list, *piece.view, piece.moment);
    const auto outline = [&](const Target& target) {
      add_outlines(list, target, rep_of(target), pose_of(target), figure_.line_width, style());
    };
    if (piece.inset != nullptr && piece.inset->target.kind != Target::Kind::contact)
      outline(piece.inset->target);
    std::vector<std::pair<const Callout*, Vector2d>> out;
    for (std::size_t i = 0; i < figure_.callouts.size(); ++i) {
      const Callout& callout = figure_.callouts[i];
      if (!callout.panel.empty() && callout.panel != letter_of(piece.panel)) continue;
      const Eigen::Vector3d point = anchor(callout.target, rep_of(callout.target), pose_of(callout.target));
      const auto at = view.to_pixel(point);
      if (!at || !piece.shown.contains(*at)) continue;
      const bool in_inset = std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
        return p.inset != nullptr && p.panel == piece.panel && p.shown.contains(*at);
      });
      if (piece.inset == nullptr && in_inset) continue;
      outline(callout.target);
      render::DrawPoint dot;
      dot.x = point;
      dot.colour = style().ink;
      dot.radius = static_cast<float>(callout_radius());
      dot.halo = style().paper;
      dot.halo_width = static_cast<float>(figure_.line_width);
      dot.layer = render::Layer::on_top;
      list.points.push_back(dot);
      out.emplace_back(&callout, *at);
      called_out_.insert(i);
    }
    return out;
  }

  struct PlacedCallouts {
    std::vector<std::string> texts;
    std::vector<Vector2d> anchors;
    std::vector<CalloutPlace> places;
  };

  /// Places the callouts that add_marks() returned for a piece.
  PlacedCallouts placed(const Piece& piece, const render::DrawList& list,
                        const std::vector<std::pair<const Callout*, Vector2d>>& callouts) {
    PlacedCallouts out;
    if (callouts.empty()) return out;
    auto& [texts, anchors, places] = out;
    std::vector<Vector2d> sizes;
    const AlignedBox2d& box = piece.place.box;
    for (const auto& [callout, at] : callouts) {
      texts.push_back(callout->text.empty() ? name_of(callout->target, recorded_.reps.size())
                                            : callout->text);
      anchors.push_back(box.min() + (at - piece.shown.min()) * piece.scale);
      sizes.emplace_back(render::text_width(texts.back(), layout_.text_height) + 0.3 * figure_.font_size,
                         layout_.text_height);
      if (sizes.back().x() > box.sizes().x() || sizes.back().y() > box.sizes().y())
        throw InputError(callout->option + ": the text \"" + texts.back() + "\" is wider than its panel of " +
                         length_text(box.sizes().x()) +
                         "; use a shorter =TEXT, a smaller --font-size, fewer --columns or a larger --width");
    }
    // The content, one pixel per point.
    render::RasterOptions raster;
    raster.width = std::max(1, static_cast<int>(std::ceil(box.sizes().x())));
    raster.height = std::max(1, static_cast<int>(std::ceil(box.sizes().y())));
    raster.supersample = 1;
    raster.labels = false;
    raster.background.reset();
    const render::Image content =
        painter_.rasterizer.draw(list, part_of(camera(*piece.view, piece.moment), piece.shown), raster);
    std::vector<render::Canvas::Loop> frames;
    for (const Piece& p : pieces_)
      if (piece.inset == nullptr && p.inset != nullptr && p.panel == piece.panel)
        for (const render::Canvas::Loop& line : frame_of(piece, p)) frames.push_back(line);
    const Space& space = piece.place.space;
    places = place_callouts({box.min() - Vector2d(0, space.above), box.max() + Vector2d(0, space.below)}, box,
                            content, frames, anchors, sizes);
    return out;
  }

  /// Reserves space above or below panels in which texts of callouts cover the bodies, line by line.
  void reserve_space() {
    for (Block& block : blocks_) block.spaces.resize(block.seen.size());
    for (std::size_t line = 0; line < figure_.callouts.size(); ++line) {
      bool any = false;
      std::vector<std::size_t> done(blocks_.size(), 0);
      for (const Piece& piece : pieces_) {
        if (piece.inset != nullptr) continue;
        Space& space = blocks_[piece.block].spaces[done[piece.block]++];
        render::Scene shown = scene(*piece.view, piece.moment);
        const auto callouts = add_marks(shown.list, piece);
        const PlacedCallouts texts = placed(piece, shown.list, callouts);
        for (std::size_t i = 0; i < texts.places.size(); ++i) {
          if (texts.places[i].covered <= kCoveringText) continue;
          const bool above = texts.anchors[i].y() < piece.place.box.center().y();
          (above ? space.above : space.below) += layout_.text_height + kPlaceStep;
          any = true;
          break;
        }
      }
      if (!any) return;
      lay_out_all();
    }
  }

  /// Paints the texts of callouts, with leaders to their anchors.
  void paint_callouts(render::Canvas& canvas, const Piece& piece, const render::DrawList& list,
                      const std::vector<std::pair<const Callout*, Vector2d>>& callouts) {
    const auto [texts, anchors, places] = placed(piece, list, callouts);
    const double width = std::max(kHairline, figure_.line_width);
    for (std::size_t i = 0; i < places.size(); ++i) {
      // From the text to the rim of the point, which is a disc, or a ring if it is hidden.
      const Vector2d direction = anchors[i] - places[i].leader;
      const Vector2d end = anchors[i] - std::min(callout_radius(), direction.norm()) * direction.normalized();
      canvas.stroke({places[i].leader, end}, false, {style().paper, 3 * width, 0});
      canvas.stroke({places[i].leader, end}, false, {style().ink, width, 0});
    }
    for (const CalloutPlace& p : places)
      if (p.covered > kCoveringText) covered_.insert(letter_of(piece.panel));
    for (std::size_t i = 0; i < places.size(); ++i)
      canvas.text({places[i].text, texts[i], layout_.text_height, false, style().ink, render::Align::centre,
                   style().paper});
  }

  void paint_frame(render::Canvas& canvas, const Piece& panel, const Piece& inset) const {
    const double width = std::max(kHairline, 1.5 * figure_.line_width);
    // The halos of all lines lie under all lines.
    for (const double halo : {3 * width, 0.0})
      for (const render::Canvas::Loop& line : frame_of(panel, inset))
        canvas.stroke(line, line.size() > 2,
                      {halo > 0 ? style().paper : style().ink, halo > 0 ? halo : width, 0});
  }

  // ---- panels that look alike

  /// Removes states whose panels cannot be distinguished in print from those of the state before; the first
  /// and the last state stay. Returns true if any were removed.
  bool leave_out_alike(const record::ProgressReport& progress) {
    std::vector<std::vector<render::Image>> seen(moments());  // by state: its panels, in order of the views
    std::size_t done = 0;
    for (std::size_t b = 0; b < panels_.size(); ++b)
      for (const auto& [view, moment] : panels_[b]) {
        progress("compare", done++, captions_.size());
        seen[moment].push_back(in_print(*view, moment, layout_.blocks[b].scale));
      }
    std::vector<trace::EventId> kept;
    for (const std::size_t i : distinct_states(seen)) kept.push_back(chosen_.events[i]);
    const std::size_t removed = moments() - kept.size();
    if (removed == 0) return false;
    chosen_.left_out = render::counted(removed, "state is", "states are") +
                       " omitted: in grey and at this width its panel would look like the one before; "
                       "--faces, --steps and --events show any state";
    chosen_.events = std::move(kept);
    return true;
  }

  /// Draws the whole view of a state as large as in the figure, with the resolution of the eye.
  render::Image in_print(const View& view, std::size_t moment, double scale) {
    const double pixel = render::kPointsPerInch / kEyeDpi,
                 side = pixel * std::ceil(kViewSide * scale / pixel);
    PanelPlace place;
    place.box = AlignedBox2d(Vector2d(0, 0), Vector2d(side, side));
    place.seen_from = Vector2d(margin(), margin()) / scale;
    const render::Scene shown = scene(view, moment);
    return render::paint_pixels({side, side, render::kWhite, {}, {}}, kEyeDpi, [&](render::Canvas& canvas) {
      painter_.paint(canvas, shown.list, camera(view, moment), place, scale, kEyeDpi);
    });
  }

  /// Determines the content and size of each panel, and the entries of the common legend.
  void survey() {
    panels_.clear(), blocks_.clear(), captions_.clear(), key_.clear(), inset_boxes_.clear(), bar_.reset();
    for (const View& view : frames_.views) {
      if (blocks_.empty() || !figure_.contact_sheet) blocks_.emplace_back(), panels_.emplace_back();
      for (std::size_t i = 0; i < moments(); ++i) {
        const render::Scene shown = scene(view, i);
        if (!shows_anything(view)) continue;
        pictures::merge_key(key_, shown.key);
        // The text may end with the panel's largest value. That of all is in the longest text, or the last.
        const auto order = [](const std::string& text) { return std::pair(text.size(), text); };
        if (shown.scale && (!bar_ || order(bar_->text) < order(shown.scale->text))) bar_ = shown.scale;
        blocks_.back().seen.push_back(seen_box(shown.list, camera(view, i)));
        inset_boxes_.emplace_back();
        for (const Inset& inset : figure_.insets)
          if (inset.panel == letter_of(captions_.size()))
            for (const AlignedBox2d& box :
                 target_boxes(inset, projection(shown.list, view, i), rep_of(inset.target),
                              pose_of(inset.target), state_.contacts()))
              inset_boxes_.back().emplace_back(&inset, box);
        blocks_.back().insets.push_back(inset_boxes_.back().size());
        const std::string text = shortened(state_.short_caption());
        captions_.push_back(view.title.empty()      ? text
                            : figure_.contact_sheet ? view.title
                                                    : view.title + ", " + text);
        panels_.back().push_back({&view, i});
      }
      if (panels_.back().empty()) blocks_.pop_back(), panels_.pop_back();
    }
    name_bodies_only(key_);
    if (blocks_.empty()) throw InputError("figure of contacts: expected a panel with a contact, found none");
    letter();
  }

  /// Returns false for a close-up of a contact without contacts, beside other views.
  bool shows_anything(const View& view) const {
    return view.camera != pictures::FrameSpec::Camera::contact || frames_.views.size() == 1 ||
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
                              (figure_.titles ? title_of(captions_[panel]) : ""));
  }

  void paint_all(render::Canvas& canvas, const record::ProgressReport& progress) {
    std::vector<render::DrawTriangle> shaded;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      progress("draw", i, pieces_.size());
      const Piece& piece = pieces_[i];
      render::Scene shown = scene(*piece.view, piece.moment);
      if (figure_.occlusion && !flat()) {
        // An inset shows the scene of the panel before it.
        if (piece.inset == nullptr) {
          render::add_ambient_occlusion(shown.list, painter_.rasterizer);
          shaded = shown.list.triangles;
        } else {
          shown.list.triangles = shaded;
        }
      }
      const auto callouts = add_marks(shown.list, piece);
      painter_.paint(canvas, shown.list, camera(*piece.view, piece.moment), piece.place, piece.scale, dpi_,
                     vector_faces_.empty() ? nullptr : &vector_faces_[i]);
      if (piece.inset != nullptr) {
        canvas.stroke(render::corners(piece.place.box), true,
                      {style().ink, std::max(kHairline, 1.5 * figure_.line_width), 0});
      } else if (runs_over(blocks_[piece.block])) {
        canvas.stroke(render::corners(piece.place.box), true, {style().faint, kHairline, 0});
      }
      if (piece.inset == nullptr)
        for (std::size_t k = i + 1; k < pieces_.size() && pieces_[k].inset != nullptr; ++k)
          paint_frame(canvas, piece, pieces_[k]);
      paint_callouts(canvas, piece, shown.list, callouts);
      paint_title(canvas, piece.place);
    }
    paint_key(canvas, layout_, figure_.legend ? key_ : std::vector<render::LegendItem>(),
              figure_.legend ? bar_ : std::nullopt, style());
    for (const auto& [y, line] : layout_.caption)
      canvas.text({{0, y}, line, layout_.text_height, false, style().ink});
  }

  void paint_title(render::Canvas& canvas, const PanelPlace& place) const {
    double y = place.box.max().y() + place.space.below + 0.65 * figure_.font_size;
    for (const std::string& line : place.lines) {
      canvas.text({{place.box.center().x(), y},
                   line,
                   layout_.text_height,
                   false,
                   style().ink,
                   render::Align::centre,
                   place.insets.empty() ? render::kTransparent : style().paper});
      y += 1.3 * figure_.font_size;
    }
  }

  /// Finds the visible faces of all panels in painting order, if none has too many.
  void find_vector_faces(std::vector<std::string>& notes, const record::ProgressReport& progress) {
    const auto draw_image = [&](const Piece& piece, std::size_t count, const std::string& why) {
      vector_faces_.clear();
      notes.push_back("faces are an image of " + render::short_number(dpi_) + " dpi: " +
                      (captions_.size() > 1 ? "panel " + render::panel_letter(piece.panel) + " has " : "") +
                      render::counted(count, "visible face", "visible faces") + ", " + why);
    };
    // Step 1: the faces of all panels, because ordering them takes longer.
    std::vector<std::vector<std::uint32_t>> visible;
    for (const Piece& piece : pieces_) {
      progress("find visible faces", visible.size(), pieces_.size());
      const render::DrawList list = scene(*piece.view, piece.moment).list;
      const DeepView deep = deep_view(piece);
      const render::DepthImage depths =
          painter_.rasterizer.depths(list, deep.camera, deep.drawn.x(), deep.drawn.y());
      auto faces = render::visible_faces(list, deep.projection(list), depths);
      if (!faces) return;
      if (faces->size() > figure_.vector_faces)
        return draw_image(piece, faces->size(),
                          "more than --vector-faces " + std::to_string(figure_.vector_faces));
      visible.push_back(std::move(*faces));
    }
    // Step 2: their order.
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      progress("order visible faces", i, pieces_.size());
      const render::DrawList list = scene(*pieces_[i].view, pieces_[i].moment).list;
      const render::Projection on_paper = deep_view(pieces_[i]).projection(list);
      auto ordered = render::painting_order(list, on_paper, looks(list, on_paper), visible[i]);
      if (!ordered) return draw_image(pieces_[i], visible[i].size(), "which intersect each other too often");
      vector_faces_.push_back(std::move(*ordered));
    }
  }

  DeepView deep_view(const Piece& piece) const {
    return painter_.deep_view(camera(*piece.view, piece.moment), piece.place, piece.scale, dpi_);
  }

  const frames::RecordedRun& recorded_;
  const FigureSpec& figure_;
  pictures::FrameSpec frames_;
  double dpi_;
  Chosen chosen_;
  pictures::Framing framing_;
  frames::FrameState state_;
  PanelPainter painter_;
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
  /// (panels) insets with the boxes of their targets in the view
  std::vector<std::vector<std::pair<const Inset*, AlignedBox2d>>> inset_boxes_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<render::ScreenFace>>
      vector_faces_;                  ///< (pieces) faces to draw as vector graphics; empty: image
  std::set<std::size_t> called_out_;  ///< callouts that were drawn
  std::set<std::string> covered_;     ///< letters of panels with texts of callouts over the bodies
};

}  // namespace

Figure draw_figure(const frames::RecordedRun& recorded, const pictures::FrameSpec& frames,
                   const FigureSpec& figure, const record::ProgressReport& progress) {
  return FigureJob(recorded, frames, figure).draw(progress);
}

}  // namespace lrb::figure
