#pragma once
/// Pickles: the members of a value as bytes, for the same version of lrbscope and of the members.

#include <string>
#include <type_traits>

#include "python/src/arguments.hpp"
#include <lrbscope/core/fields.hpp>

namespace lrb::python {

/// Calls visit(members...) for a record without bases.
template <class Record, class Visit>
void with_members(Record& record, const Visit& visit) {
  constexpr std::size_t n = lrb::detail::member_count<Record>();
  static_assert(2 <= n && n <= 16, "add a line for this number of members");
#define LRB_MEMBERS(N, ...)       \
  if constexpr (n == N) {         \
    auto& [__VA_ARGS__] = record; \
    visit(__VA_ARGS__);           \
  }
  LRB_MEMBERS(2, a, b);
  LRB_MEMBERS(3, a, b, c);
  LRB_MEMBERS(4, a, b, c, d);
  LRB_MEMBERS(5, a, b, c, d, e);
  LRB_MEMBERS(6, a, b, c, d, e, f);
  LRB_MEMBERS(7, a, b, c, d, e, f, g);
  LRB_MEMBERS(8, a, b, c, d, e, f, g, h);
  LRB_MEMBERS(9, a, b, c, d, e, f, g, h, i);
  LRB_MEMBERS(10, a, b, c, d, e, f, g, h, i, j);
  LRB_MEMBERS(11, a, b, c, d, e, f, g, h, i, j, k);
  LRB_MEMBERS(12, a, b, c, d, e, f, g, h, i, j, k, l);
  LRB_MEMBERS(13, a, b, c, d, e, f, g, h, i, j, k, l, m);
  LRB_MEMBERS(14, a, b, c, d, e, f, g, h, i, j, k, l, m, q);
  LRB_MEMBERS(15, a, b, c, d, e, f, g, h, i, j, k, l, m, q, o);
  LRB_MEMBERS(16, a, b, c, d, e, f, g, h, i, j, k, l, m, q, o, p);
#undef LRB_MEMBERS
}

/// Appends values to bytes, or reads them back: all members of records that own memory, unless there is a
/// function members(Archive&, Class&), which calls the archive with some; of other classes the bytes are
/// kept.
class Archive {
 public:
  Archive() = default;  ///< for writing
  /// For reading a pickle's state. Throws InputError for one of another version of lrbscope.
  explicit Archive(const py::tuple& state);
  py::tuple state();
  bool reads() const { return reads_; }
  /// Throws InputError if a state has more than was read, or is of classes with other members.
  void check_end();

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <class Value>
  void one(Value& value) {
    layout_ = layout_ * 31 + sizeof(Value);
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
  std::size_t layout_ = 0;  ///< hash of the sizes of all values
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
