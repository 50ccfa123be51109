#include "scenarios/golden/effects.hpp"

#include <algorithm>
#include <type_traits>

#include "scenarios/io/number_text.hpp"
#include "trace/hex.hpp"
#include "trace/record_fields.hpp"

namespace lrb::golden {
namespace {

std::string words(std::uint64_t value) {
  return std::to_string(value);
}
std::string words(double value) {
  return io::number_text(value);
}
std::string words(bool value) {
  return value ? "yes" : "no";
}
std::string words(const std::optional<Separation>& s) {
  return s ? "proved by " + std::to_string(s->face_count[0]) + " and " + std::to_string(s->face_count[1]) +
                 " faces"
           : "none";
}
template <class Measured>
std::string words(const std::optional<Measured>& m) {
  return m ? trace::words(*m) : "none";
}
std::string words(const std::vector<std::uint32_t>& values) {
  std::string out;
  for (const std::uint32_t value : values) out.append(out.empty() ? "" : ", ").append(std::to_string(value));
  return out;
}
template <class Enum>
requires std::is_enum_v<Enum> std::string words(Enum value) {
  return std::string(name_of(value));
}

std::string name_in_words(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

/// Compares the fields of two records, and those of their counters.
template <class Record>
void compare(const Record& x, const Record& y, Effect like, std::vector<Effect>& out) {
  std::vector<Effect> counters;
  for_each_field<Record>([&](const auto& field) {
    const auto &expected = x.*field.member, &found = y.*field.member;
    if (expected == found) return;
    if constexpr (std::is_same_v<decltype(expected), const Counters&>) {
      Effect work = like;
      work.kind = Effect::Kind::work;
      compare(expected, found, work, counters);
    } else {
      like.what = name_in_words(field.name);
      like.expected = words(expected);
      like.found = words(found);
      if constexpr (std::is_same_v<decltype(expected), const std::uint64_t&>)
        if (field.form == Form::hash) {
          like.expected = trace::to_hex(expected);
          like.found = trace::to_hex(found);
        }
      out.push_back(like);
    }
  });
  out.insert(out.end(), counters.begin(), counters.end());
}

}  // namespace

std::vector<double> contact_lengths(const run::Recording& recording) {
  std::vector<double> out;
  if (!recording.trace.header.request.contacts) return out;
  for (const CollideResult& r : recording.results) {
    double length = 0;
    for (const ContactRegion& region : r.regions) length += region.length;
    out.push_back(length);
  }
  return out;
}

std::vector<Effect> find_effects(const Golden& golden, const GoldenRun& run) {
  const std::vector<trace::Step>&expected = golden.trace.steps, &found = run.recording.trace.steps;
  const std::vector<double>& lengths = golden.facts.contact_lengths;
  const std::vector<double> lengths_now = contact_lengths(run.recording);
  std::vector<Effect> out;
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
    Effect like;
    like.step = found[i].index;
    std::vector<Effect> of_step;
    if (expected[i].finished && found[i].finished)
      compare(expected[i].result, found[i].result, like, of_step);
    if (i < lengths.size() && i < lengths_now.size() && lengths[i] != lengths_now[i]) {
      like.what = "length of contact";
      like.expected = words(lengths[i]);
      like.found = words(lengths_now[i]);
      like.kind = Effect::Kind::measure;
      of_step.push_back(like);
    }
    out.insert(out.end(), of_step.begin(), of_step.end());
  }
  if (expected.size() != found.size())
    out.push_back({static_cast<std::uint32_t>(std::min(expected.size(), found.size())), "number of steps",
                   std::to_string(expected.size()), std::to_string(found.size()), Effect::Kind::answer});
  std::stable_sort(out.begin(), out.end(), [](const Effect& x, const Effect& y) { return x.kind < y.kind; });
  return out;
}

}  // namespace lrb::golden
