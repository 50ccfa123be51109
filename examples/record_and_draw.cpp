// record_and_draw A B X Y Z OUT: records a query (OUT.json, for ui.perfetto.dev) and draws it (OUT.png).
#include <cstdlib>
#include <exception>
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>

int main(int argc, char** argv) try {
  if (argc != 7) throw lrb::InputError("usage: record_and_draw A B X Y Z OUT");
  const lrb::Body a = lrb::Body::load(argv[1]).value(), b = lrb::Body::load(argv[2]).value();
  const lrb::Pose pose = lrb::Pose::translation({std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])});
  lrb::trace::Recorder recorder(a, b, {});
  recorder.begin_step(0, {}, pose);
  recorder.end_step(lrb::collide(a, {}, b, pose, {}, recorder));
  const lrb::trace::Trace trace = recorder.take();
  lrb::trace::save_trace(trace, std::string(argv[6]) + ".json");
  std::cout << trace.events.size() << " events\n";
  // A cursor rebuilds the wrappers of both bodies after any event: here, after the first contact.
  lrb::trace::Cursor cursor(trace, a, b);
  cursor.next(lrb::EventKind::contact);  // stays before the first event if there is no contact
  lrb::render::SceneHighlight highlight;
  if (const auto pair = cursor.pair_under_test()) highlight.under_test = {pair->simplex_a, pair->simplex_b};
  lrb::render::SceneBody bodies[2];
  bodies[0].rep = &a.rep();
  bodies[0].wrapper = &cursor.wrapper(lrb::Side::a);
  bodies[1].rep = &b.rep();
  bodies[1].wrapper = &cursor.wrapper(lrb::Side::b);
  bodies[1].pose = pose;
  const lrb::render::DrawList list = lrb::render::build_scene(bodies, highlight).list;
  const lrb::render::Camera camera = lrb::render::fit_camera(lrb::render::extent_points(list), 1280, 720);
  lrb::render::write_png(lrb::render::Rasterizer().draw(list, camera), std::string(argv[6]) + ".png");
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
