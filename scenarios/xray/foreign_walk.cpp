#include "scenarios/xray/foreign_walk.hpp"

#include <charconv>
#include <cstdio>
#include <memory>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/number_text.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/workers/child.hpp"
#include "scenarios/workers/workers.hpp"

namespace lrb::xray {
namespace {

void append(std::string& text, double x) {
  constexpr int kAllDigits = 17;
  text += io::number_text(x, kAllDigits);
  text += ' ';
}

void append(std::string& text, const LrbRep& rep) {
  const methods::Triangles t = methods::triangles_of(rep);
  text += std::to_string(t.vertices.size()) + " " + std::to_string(t.triangles.size()) + "\n";
  for (const Eigen::Vector3d& v : t.vertices)
    for (int i = 0; i < 3; ++i) append(text, v[i]);
  for (const auto& corners : t.triangles)
    for (const VertexId v : corners) text += std::to_string(v) + " ";
}

void append(std::string& text, const Pose& pose) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) append(text, column < 3 ? pose.r(row, column) : pose.t[row]);
}

/// Reads the words of a line one by one.
class Words {
 public:
  Words(std::string_view line, const std::string& engine) : rest_(line), engine_(engine) {}

  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(' ');
    if (begin == std::string_view::npos) fail();
    const std::size_t end = std::min(rest_.find(' ', begin), rest_.size());
    const std::string_view out = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return out;
  }
  template <class Number>
  Number number() {
    const std::string_view text = word();
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail();
    return value;
  }
  bool is_at_end() const { return rest_.find_first_not_of(' ') == std::string_view::npos; }
  std::string_view rest() const { return rest_; }
  [[noreturn]] void fail() const {
    throw EnvironmentError("lrbscope-xray-" + engine_ +
                           " printed a line that is not understood: build it anew");
  }

 private:
  std::string_view rest_;
  const std::string& engine_;
};

/// Reads what a program printed.
class Reader {
 public:
  Reader(const std::vector<std::string>& lines, const std::string& engine) : lines_(lines), engine_(engine) {}

  ForeignWalk run(std::span<const LrbRep* const> reps, std::size_t poses) {
    ForeignWalk out;
    Words title = next("title");
    out.title = title.rest().substr(1);
    for (std::size_t side = 0; side < 2; ++side) out.trees[side] = tree(*reps[side]);
    while (out.steps.size() < poses) out.steps.push_back(step(out.trees, reps));
    return out;
  }

 private:
  /// Returns the words of the next line after its first one, which must be this.
  Words next(std::string_view first) {
    Words words = next();
    if (words.word() != first) words.fail();
    return words;
  }
  Words next() {
    if (at_ == lines_.size()) Words("", engine_).fail();
    return {lines_[at_++], engine_};
  }

  trace::TreeShape tree(const LrbRep& rep) {
    const auto count = next("tree").number<std::uint32_t>();
    trace::TreeShape out;
    for (std::uint32_t i = 0; i < count; ++i) {
      Words words = next();
      std::vector<std::uint32_t> children;
      std::vector<SimplexId> simplices;
      const std::string_view kind = words.word();
      const auto number = words.number<std::uint32_t>();  // of children or simplices
      for (std::uint32_t k = 0; k < number; ++k) {
        const auto n = words.number<std::uint32_t>();
        if (kind == "node" ? n >= count : n >= rep.real_simplex_count()) words.fail();
        if (kind == "node")
          children.push_back(n);
        else
          simplices.emplace_back(n);
      }
      trace::ShapeBox box;
      for (int k = 0; k < 3; ++k) box.centre[k] = words.number<double>();
      for (Eigen::Vector3d& half : box.half)
        for (int k = 0; k < 3; ++k) half[k] = words.number<double>();
      out.add(children, simplices, box);
    }
    out.finish();
    if (out.size() == 0 || out.beneath(0) != rep.real_simplex_count()) next().fail();
    return out;
  }

  ForeignStep step(const std::array<trace::TreeShape, 2>& trees, std::span<const LrbRep* const> reps) {
    next("pose");
    ForeignStep out;
    for (;;) {
      Words words = next();
      const std::string_view kind = words.word();
      if (kind == "end") {
        out.box_tests = words.number<std::uint64_t>();
        out.leaf_tests = words.number<std::uint64_t>();
        return out;
      }
      ForeignEvent e{kind == "t", 0, 0, false};
      e.a = words.number<std::uint32_t>();
      e.b = words.number<std::uint32_t>();
      e.meet = words.number<int>() != 0;
      const bool known = e.is_leaf_test
                             ? e.a < reps[0]->real_simplex_count() && e.b < reps[1]->real_simplex_count()
                             : kind == "b" && e.a < trees[0].size() && e.b < trees[1].size();
      if (!known) words.fail();
      out.events.push_back(e);
    }
  }

  const std::vector<std::string>& lines_;
  const std::string& engine_;
  std::size_t at_ = 0;
};

}  // namespace

ForeignWalk walk_of(const std::string& engine, const LrbRep& a, const LrbRep& b,
                    std::span<const PosePair> poses) {
  constexpr std::chrono::seconds kLimit(600);
  const std::string program = workers::program_beside("lrbscope-xray-" + engine);
  if (program.empty())
    throw EnvironmentError("--method " + engine + ": there is no program lrbscope-xray-" + engine +
                           " beside lrbscope; install lib" + engine +
                           "-dev and build it: cmake --build --preset release --target lrbscope-workers");
  for (const LrbRep* rep : {&a, &b})
    if (rep->real_simplex_count() < 2)
      throw InputError(printable_name(rep->name()) + ": has one triangle; give a body with two or more");
  std::string text;
  append(text, a);
  append(text, b);
  text += std::to_string(poses.size()) + "\n";
  for (const PosePair& p : poses)
    for (const Pose* pose : {&p.a, &p.b}) {
      methods::check_rigid(*pose);
      append(text, *pose);
    }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  if (!file || std::fputs(text.c_str(), file.get()) < 0 || std::fflush(file.get()) != 0)
    throw EnvironmentError("no temporary file can be written; is the disk full?");
  std::rewind(file.get());
  const std::vector<std::string> lines = workers::lines_of({program}, kLimit, fileno(file.get()));
  if (lines.empty())
    throw EnvironmentError("--method " + engine + ": " + program + " failed, or took longer than " +
                           std::to_string(kLimit.count()) + " s");
  const LrbRep* const reps[] = {&a, &b};
  return Reader(lines, engine).run(reps, poses.size());
}

}  // namespace lrb::xray
