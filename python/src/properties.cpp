#include "python/src/properties.hpp"

#include <cstring>

#include "python/src/pickle.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::python {

py::array array_of(const std::vector<std::string>& texts) {
  return py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "U16");
}

py::object parsed_json(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

Archive::Archive(const py::tuple& state) : reads_(true) {
  const py::tuple expected = this->state();
  if (state.size() != 3 || !state[0].equal(expected[0]) || !state[1].equal(expected[1]))
    throw InputError("the pickle comes from another version of lrbscope; pickle the object again");
  all_ = state[2].cast<std::string>();
}

py::tuple Archive::state() const {
  return py::make_tuple(trace::lrbscope_version(), kPickleVersion, py::bytes(all_));
}

void Archive::bytes(char* at, std::size_t n) {
  if (reads_) {
    check(n);
    std::memcpy(at, all_.data() + next_, n);
    next_ += n;
  } else {
    all_.append(at, n);
  }
}

void Archive::check(std::size_t n) const {
  if (n > all_.size() - next_) throw InputError("the pickle is damaged: it ends early");
}

void Archive::check_end() const {
  if (next_ != all_.size()) throw InputError("the pickle is damaged: it does not end where it should");
}

std::size_t checked_index(const py::object& i, std::size_t n) {
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(i.ptr()));
  if (!index) throw py::error_already_set();
  return checked_index(index.cast<py::ssize_t>(), n);
}

std::size_t checked_index(py::ssize_t i, std::size_t n) {
  const auto size = static_cast<py::ssize_t>(n);
  if (i < 0) i += size;
  if (i < 0 || i >= size) throw py::index_error("index out of range");
  return static_cast<std::size_t>(i);
}

}  // namespace lrb::python
