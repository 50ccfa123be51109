#include <cstring>
#include <limits>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/support/lrb_files.hpp"
#include "tests/support/lrb_shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::fuzz {
namespace {

/// Good files: by hand, built, one that meets itself, without levels and with them.
const std::vector<std::string>& good_files() {
  static const std::vector<std::string> files = [] {
    const LrbRep plate(toy::notched_plate()), pit(toy::dented_tetrahedron()), box(toy::dented_box());
    const LrbRep torus = build_lrb(shapes::torus(6, 4)), rock = build_lrb(shapes::bumpy_sphere(1, 1, 0.3));
    const Mesh ball = shapes::icosphere(0);
    const LrbRep twins = build_lrb(shapes::several({ball, shapes::translated(ball, {0.9, 0.2, 0.1})}));
    std::vector<std::string> out;
    for (const LrbRep* rep : {&plate, &pit, &box, &torus, &rock, &twins}) {
      out.push_back(test::lrb_bytes(*rep));
      rep->levels();
      out.push_back(test::lrb_bytes(*rep));
    }
    return out;
  }();
  return files;
}

/// A run of numbers in a file.
struct Section {
  std::size_t at, element, count;
  bool counted;  ///< its length is in the eight bytes before
};

template <class T>
T number_at(const std::string& file, std::size_t at) {
  T x{};
  if (at + sizeof x <= file.size()) std::memcpy(&x, file.data() + at, sizeof x);
  return x;
}

/// Returns what a file consists of, as far as its lengths make sense.
std::vector<Section> sections_of(const std::string& file) {
  std::vector<Section> out;
  std::size_t at = test::kVersionAt;
  const auto add = [&](std::size_t element, bool counted) {
    const std::uint64_t count = counted ? number_at<std::uint64_t>(file, at) : 1;
    const std::size_t begin = at + (counted ? sizeof count : 0);
    if (begin > file.size() || count > (file.size() - begin) / element) return false;
    out.push_back({begin, element, static_cast<std::size_t>(count), counted});
    at = begin + element * count;
    return true;
  };
  bool whole = add(4, false) && add(4, false) && add(4, false) && add(4, false);  // version to flags
  for (const std::size_t element : {1, 24, 4, 4, 4, 4, 2}) whole = whole && add(element, true);
  whole = whole && add(8, false);  // the hash
  const auto tree = [&] { return add(sizeof(TreeNode), true) && add(sizeof(LeafBlock), true); };
  whole = whole && tree() && add(4, false);
  if (!whole || number_at<std::uint32_t>(file, at - 4) == 0 || !add(8, true)) return out;
  const auto levels = number_at<std::uint64_t>(file, at);
  if (add(8, false))
    for (std::uint64_t i = 0; i < levels && add(8, false) && tree(); ++i) {
    }
  return out;
}

constexpr std::uint32_t kWords[] = {0,          1,          2,          7,          255,        256,
                                    65535,      1u << 30,   0x7f800000, 0x7fc00000, 0x7fffffff, 0x80000000,
                                    0xfffffffc, 0xfffffffd, 0xfffffffe, 0xffffffff};
constexpr double kNumbers[] = {0,
                               -0.0,
                               1,
                               -1,
                               5e-324,
                               1e-160,
                               -1e-160,
                               1e160,
                               -1e160,
                               1.7e308,
                               -1.7e308,
                               std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()};

/// Changes one field. Five bytes say which and how.
void damage(std::string& file, std::string_view how) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(how[i]); };
  const std::vector<Section> sections = sections_of(file);
  const Section& s = sections[byte(0) % sections.size()];
  const std::size_t place = byte(2) + 256U * byte(3), value = byte(4);
  const std::size_t element = s.count > 0 ? s.at + place % s.count * s.element : s.at;
  const auto set = [&](std::size_t at, const void* bytes, std::size_t size) {
    if (at + size <= file.size()) std::memcpy(file.data() + at, bytes, size);
  };
  const auto set_count = [&](std::uint64_t count) {
    if (s.counted) set(s.at - sizeof count, &count, sizeof count);
  };
  const std::size_t in_words = s.count * s.element / 4;
  switch (byte(1) % 8) {
    case 0:
      if (in_words > 0) set(s.at + place % in_words * 4, &kWords[value % std::size(kWords)], 4);
      break;
    case 1:
      if (in_words > 1) set(s.at + place % (in_words / 2) * 8, &kNumbers[value % std::size(kNumbers)], 8);
      break;
    case 2:
      if (s.count > 0) file[s.at + place % (s.count * s.element)] = static_cast<char>(value);
      break;
    case 3:
      if (s.counted && s.count > 0) {
        file.erase(element, s.element);
        set_count(s.count - 1);
      }
      break;
    case 4:
      if (s.counted && s.count > 0) {
        file.insert(element, std::string(file, element, s.element));
        set_count(s.count + 1);
      }
      break;
    case 5: {  // one element in place of another
      if (s.count == 0) break;
      const std::string other(file, s.at + value % s.count * s.element, s.element);
      set(element, other.data(), other.size());
      break;
    }
    case 6:
      set_count(value < 128 ? value : ~std::uint64_t{0} >> (value % 64));
      break;
    default: {  // a number a little larger or smaller
      if (in_words == 0) break;
      const std::size_t at = s.at + place % in_words * 4;
      const std::uint32_t moved =
          number_at<std::uint32_t>(file, at) + static_cast<std::uint32_t>(static_cast<std::int8_t>(value));
      set(at, &moved, sizeof moved);
    }
  }
}

/// Rejections must be one line.
template <class Ask>
void ask(const Ask& question) {
  try {
    question();
  } catch (const InputError& e) {
    if (std::string_view(e.what()).find('\n') != std::string_view::npos) throw std::logic_error(e.what());
  }
}

/// Every reader of the body, here beside a good one. The answers may be nonsense, as the body is; they must
/// come.
void read_all(const LrbRep& rep, const LrbRep& good) {
  const Pose pose = Pose::rotation({0, 0, 1}, 0.5, {0.5, 0.25, 0});
  ask([&] {
    ValidateOptions options;
    options.wrapper_states = 3;
    static_cast<void>(validate(rep, options));
  });
  ask([&] {
    Wrapper wrapper(rep);
    for (RegionId r = 0; r < rep.region_count(); ++r) static_cast<void>(wrapper.refine_path(r));
    static_cast<void>(wrapper.boundary());
  });
  std::vector<CollideRequest> requests(7);
  requests[1].mode = Mode::first_pair;
  requests[2].contacts = requests[2].interiors_overlap = true;
  requests[3].recursion = Recursion::paper;
  requests[4].tolerance = 0.5;
  requests[5].max_tests = 50;
  requests[6].separation = true;
  for (const CollideRequest& request : requests) {
    ask([&] { static_cast<void>(collide(rep, {}, good, pose, request)); });
    ask([&] { static_cast<void>(collide(good, {}, rep, pose, request)); });
  }
  ask([&] { static_cast<void>(rep.levels().within(0.1)); });
  ask([&] { static_cast<void>(distance(rep, {}, good, pose)); });
  ask([&] { static_cast<void>(clash(rep, {}, good, pose)); });
  ask([&] { static_cast<void>(explain_walk(rep, {}, good, pose)); });
  FirstContactRequest request;
  request.max_steps = 2000;
  ask([&] {
    static_cast<void>(first_contact(rep, Motion::still({}), good,
                                    Motion::linear(Pose::translation({9, 1, 0}), {-9, 0, 0}), request));
  });
}

}  // namespace

bool feed_fields(std::string_view bytes) {
  constexpr std::size_t kEdit = 5, kMaxEdits = 4;
  if (bytes.empty()) return false;
  const std::vector<std::string>& files = good_files();
  const std::string& good = files[static_cast<std::uint8_t>(bytes[0]) % files.size()];
  std::string file = good;
  for (std::size_t i = 0; i < kMaxEdits && 1 + (i + 1) * kEdit <= bytes.size(); ++i)
    damage(file, bytes.substr(1 + i * kEdit, kEdit));
  return accepted("m.lrb", [&] {
    read_all(load_lrb(test::with_right_checksum(file), "m.lrb"), load_lrb(good, "good.lrb"));
  });
}

}  // namespace lrb::fuzz
