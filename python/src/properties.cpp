#include "python/src/properties.hpp"

#include <cstring>

#include <lrbscope/trace/trace.hpp>

namespace lrb::python {

py::array array_of(const std::vector<std::string>& texts) {
  return py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "U16");
}

py::object parsed_json(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

Archive::Archive(const py::tuple& state) : reads_(true) {
  if (state.size() != 2 || !py::object(state[0]).equal(py::str(trace::lrbscope_version())))
    throw InputError("the pickle comes from another version of lrbscope; pickle the object again");
  all_ = state[1].cast<std::string>();
}

py::tuple Archive::state() {
  bytes(reinterpret_cast<char*>(&layout_), sizeof layout_);
  return py::make_tuple(trace::lrbscope_version(), py::bytes(all_));
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

void Archive::check_end() {
  std::size_t written = 0;
  bytes(reinterpret_cast<char*>(&written), sizeof written);
  if (written != layout_ || next_ != all_.size())
    throw InputError("the pickle is damaged, or of another build of lrbscope; pickle the object again");
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
