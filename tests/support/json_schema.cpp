#include "tests/support/json_schema.hpp"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace lrb::test {

std::string schema_faults(const nlohmann::json& schema, const nlohmann::json& document,
                          const nlohmann::json& referred) {
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  valijson::Schema parsed;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(
          Adapter(schema), parsed, [&](const std::string&) { return &referred; },
          [](const nlohmann::json*) {});
  valijson::ValidationResults results;
  if (valijson::Validator().validate(parsed, Adapter(document), &results)) return "";
  std::string out;
  for (valijson::ValidationResults::Error error; results.popError(error);
       out += ": " + error.description + "\n")
    for (const std::string& part : error.context) out += part;
  return out.empty() ? "refused" : out;
}

}  // namespace lrb::test
