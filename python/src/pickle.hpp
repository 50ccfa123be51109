#pragma once
/// Pickles: the members of a value as bytes, for the same version of lrbscope.

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "python/src/arguments.hpp"

namespace lrb::python {

/// Appends values to bytes, or reads them back. A class that owns memory needs a function
/// members(Archive&, Class&), which calls the archive with its members; of other classes the bytes are kept.
class Archive {
 public:
  Archive() = default;  ///< for writing
  /// For reading a pickle's state. Throws InputError for one of another version of lrbscope.
  explicit Archive(const py::tuple& state);
  py::tuple state() const;
  bool reads() const { return reads_; }

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
        return value;
      }));
}

}  // namespace lrb::python
