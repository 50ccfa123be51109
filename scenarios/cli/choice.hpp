#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace lrb::cli {

/// Returns those of `all` that are named, in their order; all if none is named. Throws InputError for an
/// unknown name.
template <class T, class NameOf>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::string>& names, const char* what,
                      const NameOf& name_of) {
  if (names.empty()) return all;
  std::vector<std::string> known;
  std::transform(all.begin(), all.end(), std::back_inserter(known), name_of);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string& k : known) list.append(list.empty() ? "" : ", ").append(k);
    throw InputError(std::string("there is no ") + what + " '" + name + "'; known: " + list);
  }
  std::vector<T> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const T& t) { return std::find(names.begin(), names.end(), name_of(t)) != names.end(); });
  return out;
}

}  // namespace lrb::cli
