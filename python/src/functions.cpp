#include "python/src/functions.hpp"

#include <memory>
#include <stdexcept>

namespace lrb::python {

Signature::Signature(std::string_view text) {
  const std::size_t open = text.find('(');
  name = text.substr(0, open);
  bool has_star = false;
  int depth = 0;  // of parentheses within the signature
  std::string parameter;
  for (std::size_t i = open + 1; depth >= 0; ++i) {
    const char c = text.at(i);
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth >= 0) parentheses += c;
    if (depth >= 0 && (depth > 0 || c != ',')) {
      if (c != ' ' && c != '\n') parameter += c;
      continue;
    }
    if (parameter == "*")
      has_star = true;
    else if (const std::size_t equals = parameter.find('='); !parameter.empty())
      parameters.push_back({parameter.substr(0, equals), equals != std::string::npos});
    if (!has_star) positional = parameters.size();
    parameter.clear();
  }
}

Given::Given(const Signature& signature, py::handle self, py::detail::value_and_holder* made,
             const py::args& positional, std::size_t begin, const py::kwargs& named)
    : signature_(signature), self_(self), made_(made) {
  const std::vector<Signature::Parameter>& all = signature.parameters;
  if (positional.size() > begin + signature.positional) reject("too many positional arguments");
  for (std::size_t i = begin; i < positional.size(); ++i) values_[i - begin] = positional[i];
  for (const auto& [key, value] : named) {
    // A lone surrogate, which no parameter has, becomes an escape sequence.
    const std::string name =
        py::reinterpret_steal<py::bytes>(PyUnicode_AsEncodedString(key.ptr(), "utf-8", "backslashreplace"));
    std::size_t i = 0;
    while (i < all.size() && all[i].name != name) ++i;
    if (i == all.size()) reject("got an unexpected keyword argument '" + name + "'");
    if (values_[i]) reject("multiple values for argument '" + name + "'");
    values_[i] = value;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (values_[i]) continue;
    if (!all[i].is_optional) reject("missing a required argument: '" + all[i].name + "'");
    values_[i] = Py_None;
  }
}

Argument Given::optional(std::string_view name) const {
  const std::vector<Signature::Parameter>& all = signature_.parameters;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t k = (next_ + i) % all.size();
    if (name != all[k].name) continue;
    next_ = k + 1;
    return {values_[k], all[k].name.c_str()};
  }
  return {Py_None, nullptr};
}

Argument Given::operator[](std::string_view name) const {
  const Argument found = optional(name);
  if (found.name == nullptr)
    throw std::logic_error(signature_.name + " has no parameter " + std::string(name));
  return found;
}

void Given::reject(const std::string& why) const {
  throw py::type_error(signature_.name + "(): " + why);
}

void Given::reject_self() const {
  reject("got an object of another class, " + described(self_));
}

void add_function(py::handle scope, const char* text, Kind kind,
                  std::function<py::object(const Given&)> function) {
  const auto signature = std::make_shared<const Signature>(text);
  if (signature->parameters.size() > Given::kMax)
    throw std::logic_error(signature->name + ": too many parameters");
  const std::string name = kind == Kind::constructor ? "__init__" : signature->name;
  const bool is_method = kind >= Kind::method;
  // The form from which inspect and IPython read a signature; Python shows what follows it as __doc__.
  const std::string first = !is_method ? "" : signature->parameters.empty() ? "self" : "self, ";
  const std::string stated = name + "(" + first + signature->parentheses + ")\n--\n" +
                             (text + signature->name.size() + signature->parentheses.size() + 3);
  const auto call = [=](const py::args& positional, const py::kwargs& named) {
    if (!is_method) return function(Given(*signature, {}, nullptr, positional, 0, named));
    if (positional.empty()) throw py::type_error(signature->name + "(): expected an object");
    const py::object self = positional[0];
    return function(Given(*signature, self, nullptr, positional, 1, named));
  };
  const auto make = [=](py::detail::value_and_holder& made, const py::args& positional,
                        const py::kwargs& named) {
    function(Given(*signature, {}, &made, positional, 0, named));
  };
  const char* const doc = stated.c_str();
  const auto bound = kind == Kind::constructor
                         ? py::cpp_function(make, py::name("__init__"), py::is_method(scope),
                                            py::detail::is_new_style_constructor(), doc)
                     : is_method ? py::cpp_function(call, py::name(name.c_str()), py::is_method(scope), doc)
                                 : py::cpp_function(call, py::name(name.c_str()), py::scope(scope), doc);
  scope.attr(name.c_str()) =
      kind == Kind::static_method ? py::object(py::staticmethod(bound)) : py::object(bound);
}

}  // namespace lrb::python
