#pragma once

#include <string>

#include "scenarios/spec/scenario.hpp"

namespace lrb::test {

/// Returns an approach of two generated bodies, which are in contact from step 3 to step 7.
inline spec::Scenario approach(const std::string& generator, double frequency) {
  spec::Scenario s;
  s.name = generator;
  s.bodies.resize(2);
  for (spec::BodySpec& body : s.bodies) {
    body.generator = generator;
    body.parameters = {{"frequency", frequency}};
  }
  s.motion.kind = spec::Motion::Kind::approach;
  s.motion.from = {3, 0.2, 0.1};
  s.motion.steps = 1000;
  s.motion.before = 3;
  s.motion.into = 4;
  return s;
}

}  // namespace lrb::test
