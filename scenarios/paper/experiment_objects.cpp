#include "engine/core/error.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/run/recorded_run.hpp"

namespace lrb::paper {

std::vector<PaperObject> make_objects(const PaperExperiment& experiment, std::vector<std::string>& notes) {
  std::vector<PaperObject> objects;
  for (const PaperExperiment::Object& o : experiment.objects) {
    bodies::LoadedBody body = run::make_body(o.body);
    notes.insert(notes.end(), body.notes.begin(), body.notes.end());
    if (body.rep.dim() != 3)
      throw InputError("experiment " + experiment.name + ": object " + o.name +
                       " is a 2D body: give one in 3D");
    const double by = objects.empty() ? 1 : diagonal(objects[0].rep) / diagonal(body.rep);
    objects.push_back({o.name, by == 1 ? std::move(body.rep) : scaled(body.rep, by)});
  }
  return objects;
}

}  // namespace lrb::paper
