#include "scenarios/figure/figure.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <doctest/doctest.h>

#include "render/face_look.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/figure/figure_layout.hpp"
#include "scenarios/figure/figure_targets.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/support/pdf_text.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

using namespace lrb;
using namespace lrb::figure;
using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using lrb::test::count;

namespace {

/// A shipped scenario, recorded.
struct Shipped {
  spec::Scenario scenario;
  record::Recording recording;
  frames::RecordedRun run;
  explicit Shipped(const std::string& name)
      : scenario(spec::open_scenario(name)),
        recording(record::record(scenario, record::kSilent)),
        run(run::recorded_run_of(scenario, recording)) {}
};

std::vector<std::uint32_t> faces_after(const Shipped& s, const std::vector<trace::EventId>& events) {
  std::vector<std::uint32_t> out;
  for (const trace::EventId e : events)
    out.push_back(e == 0 ? s.recording.trace.header.bodies[0].outer_faces
                         : s.recording.trace.events[e].boundary);
  return out;
}

Block squares(std::size_t n) {
  Block block;
  for (std::size_t i = 0; i < n; ++i) block.seen.emplace_back(Vector2d(0, 0), Vector2d(100, 80));
  return block;
}

LayoutOptions at_width(double width) {
  LayoutOptions o;
  o.width = width;
  return o;
}

}  // namespace

TEST_CASE("parse_length() accepts mm, cm, in and pt, and rejects other lengths") {
  CHECK(parse_length("85mm", "--width", 1, 1000) == doctest::Approx(240.945));
  CHECK(parse_length("8.5cm", "--width", 1, 1000) == doctest::Approx(240.945));
  CHECK(parse_length("2in", "--width", 1, 1000) == 144);
  CHECK(parse_length("0.25pt", "--line-width", 0.25, 3) == 0.25);
  for (const char* bad : {"85", "mm", "85 mm", "85px", "", "-3mm", "1e9mm", "nanmm"}) {
    CAPTURE(std::string(bad));
    CHECK_THROWS_AS(parse_length(bad, "--width", 1, 1000), InputError);
  }
}

TEST_CASE("panels of one body: from the outermost wrapper to the body, in equal ratios of faces") {
  const Shipped s("figure2");
  const std::vector<std::uint32_t> faces = faces_after(s, choose(s.run, {}).events);
  REQUIRE(faces.size() == 6);
  CHECK(faces.front() == s.recording.trace.header.bodies[0].outer_faces);
  CHECK(faces.back() == s.recording.trace.header.bodies[0].real_faces);
  const double whole = std::log(static_cast<double>(faces.back()) / faces.front());
  for (std::size_t i = 1; i < faces.size(); ++i) {
    CAPTURE(i);
    CHECK(std::log(static_cast<double>(faces[i]) / faces[i - 1]) == doctest::Approx(whole / 5).epsilon(0.35));
  }
  const std::vector<std::uint32_t> requested =
      faces_after(s, choose(s.run, {Choice::By::faces, {9, 40, 1000}}).events);
  REQUIRE(requested.size() == 3);
  CHECK(std::abs(static_cast<int>(requested[1]) - 40) <= 3);
  CHECK(requested[2] == faces.back());
  const auto layers = choose(s.run, {Choice::By::layers, {}}).events;
  CHECK(layers.size() == s.recording.trace.header.bodies[0].layers + 1);
  CHECK(layers.back() + 1 == s.recording.trace.events.size());
}

TEST_CASE("panels of two bodies: time steps, including the first contact") {
  const Shipped s("islands");
  std::uint32_t first = 0;
  while (s.recording.trace.steps[first].result.pair_count == 0) ++first;
  bool found = false;
  for (const trace::EventId e : choose(s.run, {}).events)
    found |= s.recording.trace.steps[s.recording.trace.step_of(e)].index == first;
  CHECK(found);
  const auto requested = choose(s.run, {Choice::By::steps, {2, 0}}).events;
  REQUIRE(requested.size() == 2);
  CHECK(s.recording.trace.step_of(requested[0]) == 0);
  CHECK(s.recording.trace.step_of(requested[1]) == 2);
  CHECK_THROWS_AS(choose(s.run, {Choice::By::steps, {100'000}}), InputError);
  CHECK_THROWS_AS(choose(s.run, {Choice::By::events, {100'000'000}}), InputError);
  CHECK_THROWS_AS(choose(s.run, {Choice::By::layers, {}}), InputError);
}

TEST_CASE("a figure of a 2D body consists of lines and text, without pixels") {
  const Shipped s("figure2");
  FigureSpec spec;
  spec.format = FigureSpec::Format::svg;
  const Figure svg = draw_figure(s.run, {}, spec, record::kSilent);
  CHECK(svg.panels == 6);
  CHECK(count(svg.bytes, "<image") == 0);
  CHECK(count(svg.bytes, "aria-label=\"(f)\"") == 1);
  CHECK(count(svg.bytes, "aria-label=\"island, wrapper\"") == 1);
  CHECK(svg.caption.find("(a) outermost wrapper, 8 faces; (b)") != std::string::npos);
  spec.legend = false;
  const Figure bare = draw_figure(s.run, {}, spec, record::kSilent);
  CHECK(count(bare.bytes, "aria-label=\"island, wrapper\"") == 0);
  spec.titles = true;
  CHECK(count(draw_figure(s.run, {}, spec, record::kSilent).bytes, "(a) outermost") == 1);
  spec.format = FigureSpec::Format::pdf;
  const Figure pdf = draw_figure(s.run, {}, spec, record::kSilent);
  CHECK(count(pdf.bytes, "/Subtype /Image") == 0);
  CHECK(count(test::pdf_text(pdf.bytes), "/MediaBox [ 0 0 240.94") == 1);  // 85 mm
  CHECK(pdf.bytes == draw_figure(s.run, {}, spec, record::kSilent).bytes);
}

TEST_CASE("a figure of 3D bodies: vector graphics, or faces as pixels if there are many") {
  const Shipped s("stick_through_wall");
  FigureSpec spec;
  spec.format = FigureSpec::Format::svg;
  spec.dpi = 150;
  spec.choice.panels = 2;
  const Figure vectors = draw_figure(s.run, {}, spec, record::kSilent);
  CHECK(vectors.notes.empty());
  CHECK(count(vectors.bytes, "<image") == 0);
  CHECK(count(vectors.bytes, "stroke=\"#c41230\"") > 0);
  CHECK(count(vectors.bytes, "width=\"85mm\"") == 1);
  spec.vector_faces = 10;
  const Figure svg = draw_figure(s.run, {}, spec, record::kSilent);
  CHECK(count(svg.bytes, "<image") == svg.panels);
  REQUIRE(svg.notes.size() == 1);
  CHECK(svg.notes[0].starts_with("faces are an image of 150 dpi: panel (a) has "));
  CHECK(count(svg.bytes, "stroke=\"#c41230\"") > 0);  // palette::kContact
  CHECK(count(svg.bytes, "aria-label=\"(a)\"") == 1);
  CHECK(count(svg.bytes, "<text") == 0);
  spec.format = FigureSpec::Format::png;
  const Figure png = draw_figure(s.run, {}, spec, record::kSilent);
  const auto bytes = std::vector<std::uint8_t>(png.bytes.begin(), png.bytes.end());
  const render::DecodedPng read = render::decode_png(bytes);
  CHECK(read.image.width() == static_cast<int>(std::ceil(85 / 25.4 * 150)));
  CHECK(read.dpi == doctest::Approx(150).epsilon(0.001));
}

TEST_CASE("callouts and insets are read, and wrong ones rejected with their option") {
  const Callout callout = parse_callout("c:face:b12=a: tooth = sharp");
  CHECK(callout.panel == "c");
  CHECK(callout.target.kind == Target::Kind::face);
  CHECK(callout.target.body == 1);
  CHECK(callout.target.number == 12);
  CHECK(callout.text == "a: tooth = sharp");
  CHECK(parse_callout("region:3").panel.empty());
  CHECK(name_of(parse_callout("region:a3").target, 2) == "region 3 of A");
  const Inset inset = parse_inset("b:region:7:2.5");
  CHECK(inset.target.kind == Target::Kind::region);
  CHECK(inset.magnification == 2.5);
  CHECK(parse_inset("a:contact").magnification == 0);
  for (const char* bad :
       {"", "face", "face:", "face:c3", "face:3:4", "edge:3", "3:face:3", "face:3=", "contact", "face:-1"})
    CHECK_THROWS_AS(parse_callout(bad), InputError);
  for (const char* bad :
       {"", "face:3", "a", "a:face", "a:face:x", "a:face:3:0", "a:face:3:4:5", "a:contact:b", "A:face:3"})
    CHECK_THROWS_AS(parse_inset(bad), InputError);
}

TEST_CASE("the outline of a region: closed chains of the edges that only one lid has") {
  for (const char* name : {"figure2_mesh", "figure1"}) {
    const Shipped s(name);
    const LrbRep& rep = *s.run.reps[0];
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      std::map<std::pair<VertexId, VertexId>, int> lids_at;
      for (const FaceId f : rep.dim() == 3 ? rep.lids(r) : rep.collector(r)) {
        const std::span<const VertexId> corners = rep.face(f);
        for (std::size_t i = 0; i < (rep.dim() == 2 ? 1 : corners.size()); ++i)
          ++lids_at[std::minmax({corners[i], corners[(i + 1) % corners.size()]})];
      }
      const auto border = std::ranges::count_if(lids_at, [](const auto& edge) { return edge.second == 1; });
      std::ptrdiff_t found = 0;
      for (const std::vector<Vector3d>& chain : outlines({Target::Kind::region, 0, r}, rep, {})) {
        CHECK(chain.front() == chain.back());
        found += static_cast<std::ptrdiff_t>(chain.size()) - 1;
      }
      CHECK(found == border);
    }
  }
}

TEST_CASE("texts of callouts are inside their panel, beside its content, and apart") {
  const AlignedBox2d box(Vector2d(10, 20), Vector2d(110, 120));
  render::Image content(100, 100, render::kTransparent);
  for (int y = 30; y < 70; ++y)
    for (int x = 30; x < 70; ++x) content.at(x, y) = render::kBlack;
  const std::vector<Vector2d> anchors = {{50, 60}, {52, 60}, {70, 80}}, sizes(3, Vector2d(25, 8));
  const std::vector<CalloutPlace> places = place_callouts(box, box, content, {}, anchors, sizes);
  const AlignedBox2d centre(Vector2d(40, 50), Vector2d(80, 90));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const AlignedBox2d text(places[i].text - sizes[i] / 2, places[i].text + sizes[i] / 2);
    CHECK(box.contains(text));
    CHECK(centre.intersection(text).isEmpty());
    CHECK(text.exteriorDistance(places[i].leader) < 1e-9);
    CHECK(places[i].covered == 0);
    for (std::size_t k = 0; k < i; ++k)
      CHECK((places[i].text - places[k].text).cwiseAbs().cwiseQuotient(sizes[i]).maxCoeff() >= 1);
  }
  const std::vector<std::vector<Vector2d>> frames = {{{95, 20}, {95, 120}}};
  CHECK(std::abs(places[2].text.x() - 95) < sizes[2].x() / 2);
  for (const CalloutPlace& p : place_callouts(box, box, content, frames, anchors, sizes))
    CHECK(std::abs(p.text.x() - 95) > sizes[0].x() / 2);
  const render::Image full(100, 100, render::kBlack);
  CHECK(place_callouts(box, box, full, {}, anchors, sizes)[0].covered == 1);
  const AlignedBox2d larger(box.min() - Vector2d(0, 12), box.max() + Vector2d(0, 24));
  for (const CalloutPlace& p : place_callouts(larger, box, full, {}, anchors, sizes)) {
    CHECK(p.covered == 0);
    CHECK(box.exteriorDistance(p.text) > 0);
  }
}

TEST_CASE("an inset is below its panel, with a frame; a callout in it is not in the panel as well") {
  const Shipped s("stick_through_wall");
  FigureSpec spec;
  spec.format = FigureSpec::Format::svg;
  spec.choice.panels = 2;
  const double height = lay_out({squares(1)}, {}, {}, "", at_width(200)).height;
  Block with_inset = squares(1);
  with_inset.insets = {2};
  const FigureLayout layout = lay_out({with_inset}, {}, {}, "", at_width(200));
  REQUIRE(layout.blocks[0].panels[0].insets.size() == 2);
  for (const AlignedBox2d& inset : layout.blocks[0].panels[0].insets) {
    CHECK(inset.min().y() > height);
    CHECK(inset.max().y() <= layout.height);
    CHECK(inset.sizes().x() == doctest::Approx(inset.sizes().y()));
  }
  pictures::FrameSpec print;
  print.style = render::StyleName::print;
  const Figure plain = draw_figure(s.run, print, spec, record::kSilent);
  spec.insets = {parse_inset("b:contact:3"), parse_inset("a:region:b0")};
  spec.callouts = {parse_callout("face:b2"), parse_callout("a:region:b0=end")};
  const Figure svg = draw_figure(s.run, print, spec, record::kSilent);
  CHECK(svg.notes.empty());
  CHECK(count(svg.bytes, "<clipPath") == count(plain.bytes, "<clipPath") + 2);
  CHECK(count(svg.bytes, "aria-label=\"face 2 of B\"") == 2);
  CHECK(count(svg.bytes, "aria-label=\"end\"") == 1);
  CHECK(count(svg.caption, " (inset: contact, 3 times as large)") == 1);
  CHECK(count(svg.caption, " (inset: region 0 of B, ") == 1);
  spec.vector_faces = 10;
  spec.dpi = 100;
  CHECK(count(draw_figure(s.run, {}, spec, record::kSilent).bytes, "<image") == 4);
  spec.insets.clear();
  spec.callouts = {
      parse_callout("face:b2=a text that is much wider than a panel of half the width of the figure")};
  CHECK_THROWS_AS(draw_figure(s.run, {}, spec, record::kSilent), InputError);
}

TEST_CASE("--occlusion darkens faces in a gap, and leaves those of a convex body") {
  const auto plates = [](double gap) {
    render::DrawList list;
    for (const double z : {0.0, gap}) {
      const Mesh box = shapes::box({0, 0, z}, {1, 1, z + 0.1});
      for (FaceId f = 0; f < box.face_count(); ++f) {
        std::vector<Vector3d> corners;
        for (const VertexId v : box.face(f)) corners.push_back(box.vertices[v]);
        render::DrawTriangle like;
        like.colour = {200, 100, 50, 255};
        list.add_polygon(corners, like);
      }
    }
    return list;
  };
  render::Rasterizer rasterizer;
  render::DrawList list = plates(0.2);
  render::add_ambient_occlusion(list, rasterizer);
  int dark = 0;
  for (const render::DrawTriangle& t : list.triangles) {
    const double z = (t.x[0] + t.x[1] + t.x[2]).z() / 3;
    const bool in_gap = t.x[0].z() == t.x[1].z() && t.x[1].z() == t.x[2].z() && z > 0.05 && z < 0.25;
    if (in_gap) CHECK(t.colour.r < 120);
    if (in_gap) ++dark;
    if (z < 1e-9 || z > 0.3 - 1e-9) CHECK(t.colour == render::Rgba{200, 100, 50, 255});
  }
  CHECK(dark == 4);
}
