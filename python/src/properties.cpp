#include "python/src/properties.hpp"

#include <cstring>
#include <stdexcept>

#include "python/src/pickle.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::python {

Signature::Signature(const char* text) : text_(text) {
  const std::string_view all = text;
  const std::size_t open = all.find('(');
  name_ = all.substr(0, open);
  bool has_star = false;
  int depth = 0;  // of parentheses within the signature
  std::string argument;
  for (std::size_t i = open + 1; depth >= 0; ++i) {
    const char c = all.at(i);
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth >= 0 && (depth > 0 || c != ',')) {
      if (c != ' ' && c != '\n') argument += c;
      continue;
    }
    if (argument == "*")
      has_star = true;
    else if (const std::size_t equals = argument.find('='); !argument.empty())
      arguments_.push_back({argument.substr(0, equals), equals != std::string::npos});
    if (!has_star) positional_ = arguments_.size();
    argument.clear();
  }
}

void Signature::apply(py::detail::function_record& function) const {
  if (function.nargs_pos != arguments_.size() + (function.is_method ? 1 : 0))
    throw std::logic_error(name_ + ": the text and the function have different arguments");
  function.doc = const_cast<char*>(text_);  // pybind11 copies it, and the names
  if (function.is_method) function.args.emplace_back("self", nullptr, py::handle(), true, false);
  function.nargs_pos = static_cast<std::uint16_t>(function.args.size() + positional_);
  for (const Argument& each : arguments_)
    function.args.emplace_back(each.name.c_str(), nullptr,
                               each.is_optional ? py::none().release() : py::handle(), true, true);
}

py::object parsed_json(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

Archive::Archive(const py::tuple& state) : reads_(true) {
  if (state.size() != 2 || std::string(py::str(state[0])) != trace::lrbscope_version())
    throw InputError("the pickle comes from another version of lrbscope; pickle the object again");
  all_ = state[1].cast<std::string>();
}

py::tuple Archive::state() const {
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

std::size_t checked_index(py::ssize_t i, std::size_t n) {
  const auto size = static_cast<py::ssize_t>(n);
  if (i < 0) i += size;
  if (i < 0 || i >= size) throw py::index_error("index out of range");
  return static_cast<std::size_t>(i);
}

}  // namespace lrb::python
