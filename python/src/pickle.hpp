#pragma once
/// Pickles: the members of a value as bytes, for the same version of lrbscope and of the members.

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "python/src/arguments.hpp"
#include <lrbscope/core/fields.hpp>

namespace lrb::python {

/// Version of what pickles have. Increase it when a class that can be pickled gets other members.
inline constexpr int kPickleVersion = 1;

/// Calls visit(members...) for a record without bases.
template <class Record, class Visit>
void with_members(Record& record, const Visit& visit) {
  constexpr std::size_t n = lrb::detail::member_count<Record>();
  if constexpr (n == 2) {
    auto& [a, b] = record;
    visit(a, b);
  } else if constexpr (n == 3) {
    auto& [a, b, c] = record;
    visit(a, b, c);
  } else if constexpr (n == 5) {
    auto& [a, b, c, d, e] = record;
    visit(a, b, c, d, e);
  } else if constexpr (n == 7) {
    auto& [a, b, c, d, e, f, g] = record;
    visit(a, b, c, d, e, f, g);
  } else if constexpr (n == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = record;
    visit(a, b, c, d, e, f, g, h, i);
  } else if constexpr (n == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = record;
    visit(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (n == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = record;
    visit(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else {
    static_assert(n == 16, "add a line for this number of members");
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = record;
    visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q);
  }
}

/// Appends values to bytes, or reads them back: all members of records that own memory, unless there is a
/// function members(Archive&, Class&), which calls the archive with some; of other classes the bytes are
/// kept.
class Archive {
 public:
  Archive() = default;  ///< for writing
  /// For reading a pickle's state. Throws InputError for one of another version of lrbscope.
  explicit Archive(const py::tuple& state);
  py::tuple state() const;
  bool reads() const { return reads_; }
  /// Throws InputError if a state has more than was read.
  void check_end() const;

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <class Value>
  void one(Value& value) {
    if constexpr (requires { members(*this, value); }) {
      members(*this, value);
    } else if constexpr (std::is_trivially_destructible_v<Value>) {
      bytes(reinterpret_cast<char*>(&value), sizeof(Value));
    } else if constexpr (requires { value.emplace(); }) {  // an optional
      bool is_set = value.has_value();
      one(is_set);
      if (reads_ && is_set) value.emplace();
      if (is_set) one(*value);
    } else if constexpr (!requires { value.begin(); }) {
      with_members(value, [this](auto&... all) { (this->one(all), ...); });
    } else {  // a list
      if constexpr (requires { value.resize(1); }) {
        std::size_t n = value.size();
        one(n);
        if (reads_) check(n);
        if (reads_) value.resize(n);
      }
      if constexpr (std::is_trivially_destructible_v<typename Value::value_type>)
        bytes(reinterpret_cast<char*>(value.data()), value.size() * sizeof(typename Value::value_type));
      else
        for (auto& each : value) one(each);
    }
  }

  void bytes(char* at, std::size_t n);
  void check(std::size_t n) const;  ///< throws InputError unless there are n more bytes

  std::string all_;
  std::size_t next_ = 0;
  bool reads_ = false;
};

/// Lets objects of a class be pickled. They are immutable: a copy is the object itself.
template <class Class>
void make_copyable(Class& c) {
  const auto itself = [](const py::object& self) {
    self.cast<const typename Class::type&>();  // raises TypeError for an object without a value
    return self;
  };
  c.def("__copy__", itself);
  c.def("__deepcopy__", [itself](const py::object& self, const py::handle&) { return itself(self); });
}
template <class Class>
void make_picklable(Class& c) {
  using Value = typename Class::type;
  make_copyable(c);
  c.def(py::pickle(
      [](Value& value) {
        Archive archive;
        archive(value);
        return archive.state();
      },
      [](const py::tuple& state) {
        Archive archive(state);
        Value value;
        archive(value);
        archive.check_end();
        return value;
      }));
}

}  // namespace lrb::python
