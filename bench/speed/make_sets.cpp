#include "bench/speed/make_sets.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "bench/speed/bench_runner.hpp"
#include "bench/speed/chart_page.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
namespace lrb::speed {

Approaches::Approaches(const LrbRep& a, const LrbRep& b, double diagonal, std::uint64_t seed)
    : a_(a), b_(b), diagonal_(diagonal), random_(seed) {
  request_.mode = Mode::first_pair;
}

bool Approaches::meets(const Pose& pose_b) {
  return !collide(a_, Pose{}, b_, pose_b, request_, workspace_).value().pairs.empty();
}

Approach Approaches::next(double depth) {
  constexpr int kHalvings = 40;
  while (true) {
    Approach out;
    out.pose.r = shapes::random_rotation(random_);
    out.direction = shapes::random_direction(random_);
    const Eigen::Vector3d centre = shapes::box_of(a_).center() - out.pose.r * shapes::box_of(b_).center();
    const auto meets_at = [&](double s) {
      out.pose.t = centre + s * out.direction;
      return meets(out.pose);
    };
    // The largest distance at which steps, from afar, find an intersection; then bisected.
    double at = 2 * diagonal_, step = 0.004 * diagonal_;
    while (at > 0 && !meets_at(at)) at -= step;
    if (at <= 0) continue;
    for (int i = 0; i < kHalvings; ++i) {
      step /= 2;
      if (meets_at(at + step)) at += step;
    }
    out.pose.t = centre + (at - depth * diagonal_) * out.direction;
    return out;
  }
}

namespace {

namespace fs = std::filesystem;

constexpr double kSmall = 0.1;  // size of B / size of A

std::uint32_t whole_root(double x) {
  return static_cast<std::uint32_t>(std::max(2.0, std::round(std::sqrt(x))));
}

class Maker {
 public:
  Maker(const BodyPair& pair, const SetOptions& options, const std::string& folder)
      : o_(options), folder_(folder), pose_b_(pair.pose_b) {
    set_.name = pair.name;
    set_.what = pair.what;
    set_.folder = folder;
    set_.quantity = options.quantity;
    const Mesh a = pair.a(), b = pair.b();
    add("a", a);
    add("b", b);
    const double size_a = shapes::box_of(reps_[0]).diagonal().norm();
    const double size_b = shapes::box_of(reps_[1]).diagonal().norm();
    set_.diagonal = std::max(size_a, size_b);
    if (options.quantity != Quantity::pairs) return;
    Mesh small = b;
    for (Eigen::Vector3d& v : small.vertices) v *= kSmall * size_a / size_b;
    add("small", small);
  }

  DataSet make() {
    if (pose_b_) {
      add_interlocked();
      return std::move(set_);
    }
    for (const PoseClass c : classes_of(o_.quantity)) {
      if (o_.quantity != Quantity::pairs)
        add_posed(c);
      else if (c == PoseClass::identical)
        add_identical();
      else
        add_approaches(c, c == PoseClass::small ? 2 : 1);
    }
    return std::move(set_);
  }

 private:
  void add(const char* role, const Mesh& mesh) {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::string> notes;
    reps_.push_back(bodies::build_from_mesh(check(mesh), {}, notes));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::string file = set_.name + "-" + role + ".lrb";
    save_lrb(reps_.back(), folder_ + "/" + file);
    set_.bodies.push_back({file, reps_.back().real_simplex_count(), seconds});
  }

  void ask(PoseClass c, std::size_t a, std::size_t b, const Pose& pose_a, const Pose& pose_b) {
    Question q;
    q.pose_class = c;
    q.a = a;
    q.b = b;
    q.pose_a = pose_a;
    q.pose_b = pose_b;
    q.expected = exact_pairs(reps_[a], pose_a, reps_[b], pose_b);
    set_.questions.push_back(std::move(q));
  }

  /// Adds B near its pose, turned and moved by little enough to stay apart from A.
  void add_interlocked() {
    constexpr double kTurn = 0.02, kShift = 0.03;
    shapes::RandomEngine random(o_.seed);
    for (int i = 0; i < o_.poses; ++i) {
      Question q;
      q.pose_class = PoseClass::interlocked;
      q.b = 1;
      const Eigen::Vector3d axis = shapes::random_direction(random);
      q.pose_b.r = deterministic::rotation(axis, shapes::uniform(random, -kTurn, kTurn)) * pose_b_->r;
      q.pose_b.t = pose_b_->t + shapes::uniform(random, 0, kShift) * shapes::random_direction(random);
      set_.questions.push_back(std::move(q));
    }
  }

  /// Adds B at one pose, or on a straight motion that is two diagonals long and starts at a random distance,
  /// so that no method that samples equal times is favoured.
  void add_posed(PoseClass c) {
    Approaches approaches(reps_[0], reps_[1], set_.diagonal, o_.seed);
    shapes::RandomEngine random(o_.seed);
    for (int i = 0; i < o_.poses; ++i) {
      const Approach approach = approaches.next(info_of(c).depth);
      Question q;
      q.pose_class = c;
      q.b = 1;
      q.pose_b = approach.pose;
      if (o_.quantity == Quantity::first_contact) {
        const bool is_into = c == PoseClass::into;
        const Eigen::Vector3d back =
            set_.diagonal * (is_into ? approach.direction : approach.direction.unitOrthogonal());
        q.from = (is_into ? shapes::uniform(random, 1.2, 1.8) : shapes::uniform(random, 0.8, 1.2)) * back;
        q.to = q.from - 2 * back;
      }
      if (o_.quantity == Quantity::near_pairs)
        q.expected = exact_pairs(reps_[0], q.pose_a, reps_[1], q.pose_b, info_of(c).within * set_.diagonal);
      set_.questions.push_back(std::move(q));
    }
  }

  void add_approaches(PoseClass c, std::size_t b) {
    Approaches approaches(reps_[0], reps_[b], set_.diagonal, o_.seed);
    // If one body is small the depth is 1 % of its own size, because it cannot be deeper.
    const double depth = info_of(c).depth * (c == PoseClass::small ? kSmall : 1);
    for (int i = 0; i < o_.poses; ++i) ask(c, 0, b, Pose{}, approaches.next(depth).pose);
  }

  void add_identical() {
    shapes::RandomEngine random(o_.seed);
    for (int i = 0; i < std::max(1, o_.poses / 4); ++i) {
      Pose p;
      p.r = shapes::random_rotation(random);
      p.t = set_.diagonal * shapes::random_direction(random);
      ask(PoseClass::identical, 0, 0, p, p);
    }
  }

  SetOptions o_;
  std::string folder_;
  std::optional<Pose> pose_b_;
  DataSet set_;
  std::vector<LrbRep> reps_;
};

std::function<Mesh()> maker(const char* name, generators::GeneratorValues values, std::uint64_t seed) {
  return [=] { return generators::generate(name, values, seed); };
}

}  // namespace

std::vector<BodyPair> generated_pairs(std::uint32_t faces) {
  const double n = faces;
  const double frequency = whole_root(n / 20);
  const double sides = std::max(3.0, std::round(std::sqrt(n / 140)));
  const double segments = std::max(12.0, std::round(n / (2 * sides)));
  const generators::GeneratorValues rock = {{"frequency", frequency}};
  const double points = std::max(4.0, std::round(std::sqrt(n / 400)));
  // A gear of 16 teeth has faces for about 64 points per ring and side.
  const generators::GeneratorValues gear = {{"points", points},
                                            {"rings", std::max(1.0, std::round(n / (64 * points)))}};
  const std::string size = std::to_string(faces);
  const std::string about = " of about " + size + " faces";
  return {
      {"rocks-" + size, "two rocks" + about, maker("rock", rock, 1), maker("rock", rock, 2)},
      {"knot-gear-" + size, "a knot and a gear" + about,
       maker("knot", {{"segments", segments}, {"sides", sides}}, 1), maker("gear", gear, 1)},
      {"balls-" + size, "two balls" + about, maker("ball", {{"frequency", frequency}}, 1),
       maker("ball", {{"frequency", frequency}}, 1)},
  };
}

std::vector<BodyPair> interlocked_pairs(std::uint32_t faces) {
  constexpr double kCoarsest = 252;  // faces of the smallest body
  std::vector<BodyPair> pairs;
  if (faces == 0) return pairs;
  const int fine = static_cast<int>(std::ceil(std::sqrt(faces / kCoarsest)));
  for (const generators::Interlocked& p : generators::interlocked(fine))
    pairs.push_back({p.name + "-" + std::to_string(faces),
                     p.name + ", interlocked, of at least " + std::to_string(faces) + " faces",
                     [a = p.a] { return a; }, [b = p.b] { return b; }, p.pose_b});
  return pairs;
}

std::vector<BodyPair> pairs_of_models(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file()) files.push_back(entry.path());
  if (error || files.size() < 2)
    throw InputError(printable_name(folder) + ": expected a folder with at least two meshes");
  std::sort(files.begin(), files.end());
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path a = files[i], b = files[(i + 1) % files.size()];
    const auto reader = [](const fs::path& p) { return [p] { return read_mesh(p.string()); }; };
    pairs.push_back({a.stem().string() + "-" + b.stem().string(),
                     a.stem().string() + " and " + b.stem().string(), reader(a), reader(b)});
  }
  return pairs;
}

std::string set_name(const BodyPair& pair, Quantity quantity) {
  return quantity == Quantity::pairs ? pair.name : pair.name + "-" + std::string(name_of(quantity));
}

DataSet make_data_set(const BodyPair& pair, const SetOptions& options, const std::string& folder) {
  const std::string mark =
      " (" + std::to_string(options.poses) + " poses per class, seed " + std::to_string(options.seed) + ")";
  BodyPair marked = pair;
  marked.what += mark;
  marked.name = set_name(pair, options.quantity);
  const std::string path = folder + "/" + marked.name + ".set.json";
  if (fs::exists(path)) {
    DataSet set = read_data_set(path);
    if (set.what == marked.what && is_complete(set)) return set;
  }
  DataSet set = Maker(marked, options, folder).make();
  if (!is_complete(set)) find_numbers(set);
  write_data_set(set, folder);
  return set;
}

namespace {

using nlohmann::ordered_json;

/// Returns the query that is the worst of most points, or the first of the class if no point has an error.
std::uint64_t question_of(const DataSet& set, const std::vector<const Point*>& panel, PoseClass c) {
  std::map<std::uint64_t, std::size_t> votes;
  for (const Point* p : panel)
    if (p->error() > 0) ++votes[p->worst_question];
  std::uint64_t best = 0;
  while (best < set.questions.size() && set.questions[best].pose_class != c) ++best;
  std::size_t most = 0;
  for (const auto& [question, count] : votes)
    if (count > most) {
      best = question;
      most = count;
    }
  return best;
}

/// Returns the poses of B in a scene: the pose of the query or, for a motion, some poses up to first contact
/// or its end.
std::vector<Pose> poses_of(const DataSet& set, const Question& q) {
  if (set.quantity != Quantity::first_contact) return {q.pose_b};
  const double last = std::min(1.0, q.number ? q.number->most : 1);
  std::vector<Pose> poses;
  for (const double share : {0.0, 0.5, 0.75, 0.9, 0.99, 1.0}) {
    Pose p = q.pose_b;
    p.t += q.from + share * last * (q.to - q.from);
    poses.push_back(p);
  }
  return poses;
}

std::string scenario_text(const DataSet& set, std::uint64_t k, const std::string& name) {
  const Question& q = set.questions[k];
  const ordered_json views = {
      {{"camera", "scene"}, {"title", "Overview with wrappers"}},
      {{"camera", "contact"}, {"draw", "body"}, {"title", "Contact without wrappers"}}};
  ordered_json poses = ordered_json::array();
  for (const Pose& pose : poses_of(set, q)) poses.push_back(io::rows_of(pose));
  ordered_json value = {
      {"name", name},
      {"purpose", set.what + ": " + info_of(q.pose_class).title + ", question " + std::to_string(k) + "."},
      {"bodies",
       {{"a", {{"file", "../" + set.bodies[q.a].file}, {"pose", io::rows_of(q.pose_a)}}},
        {"b", {{"file", "../" + set.bodies[q.b].file}}}}},
      {"motion", {{"kind", "poses"}, {"poses", poses}}},
      {"trace", {{"gzip", true}}},
      {"frames", {{"at", "step"}, {"size", {960, 540}}, {"views", views}}}};
  if (set.quantity == Quantity::pairs) value["expect"] = {{{"step", 0}, {"pairs", q.expected.size()}}};
  if (set.quantity == Quantity::near_pairs)
    value["query"] = {{"near", info_of(q.pose_class).within * set.diagonal}};
  if (set.quantity == Quantity::depth) value["query"] = {{"clash", true}};
  if (set.quantity == Quantity::distance || set.quantity == Quantity::first_contact)
    value["query"] = {{"distance", true}};
  return value.dump(2) + "\n";
}

}  // namespace

std::map<SceneKey, std::string> write_scenes(const std::vector<DataSet>& sets,
                                             const std::vector<Point>& points, const std::string& folder,
                                             const record::ProgressReport& progress) {
  std::map<SceneKey, std::string> pages;
  std::uint64_t done = 0;
  for (const DataSet& set : sets)
    for (const PoseClass c : classes_of(set.quantity)) {
      progress("scenes", done++, sets.size() * classes_of(set.quantity).size());
      const std::uint64_t k = question_of(set, panel(points, set.name, c), c);
      if (k >= set.questions.size()) continue;
      const std::string name = set.name + "-" + std::string(name_of(c));
      const std::string file = folder + "/scenes/" + name + ".scenario.json";
      const std::string text = scenario_text(set, k, name), page = "scenes/" + name + "/index.html";
      pages[{set.name, c}] = page;
      namespace fs = std::filesystem;
      if (fs::exists(folder + "/" + page) && fs::exists(file) && io::read_text(file) == text) continue;
      io::write_text(file, text);
      run::run_scenario(spec::parse_scenario(text, file), folder + "/scenes/" + name, "lrbscope run " + file,
                        record::kSilent);
    }
  return pages;
}

}  // namespace lrb::speed
