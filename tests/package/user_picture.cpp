// Records a query, reads the recording back, and draws the contact.
#include <algorithm>
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace {

lrb::Body tetrahedron() {
  Eigen::MatrixX3d v(4, 3);
  v << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Eigen::MatrixX3i f(4, 3);
  f << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return lrb::Body::from(v, f).value();
}

}  // namespace

int main() {
  const lrb::Body body = tetrahedron();
  const lrb::Pose pose = lrb::Pose::translation({0.25, 0.1, 0.05});
  lrb::trace::Recorder recorder(body, body, {});
  recorder.begin_step(0, lrb::Pose{}, pose);
  recorder.end_step(lrb::collide(body, lrb::Pose{}, body, pose, {}, recorder));
  const lrb::trace::Trace trace = recorder.take();
  if (!(lrb::trace::trace_from_json(lrb::trace::trace_to_json(trace), "trace") == trace)) return 1;

  lrb::render::SceneBody bodies[2];
  bodies[0].rep = bodies[1].rep = &body.rep();
  bodies[1].pose = pose;
  const lrb::render::Scene scene = lrb::render::build_scene(bodies);
  std::vector<Eigen::Vector3d> points = lrb::render::body_points(body, pose);
  const lrb::render::Camera camera = lrb::render::fit_camera(points, 320, 240);
  lrb::render::RasterOptions options;
  options.width = 320;
  options.height = 240;
  const lrb::render::Image image = lrb::render::Rasterizer().draw(scene.list, camera, options);
  const auto png = lrb::render::encode_png(image);
  std::cout << trace.events.size() << " events, " << png.size() << " bytes of PNG\n";
  return png.size() > 1000 ? 0 : 2;
}
