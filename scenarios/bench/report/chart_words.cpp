#include "scenarios/bench/report/chart_words.hpp"

namespace lrb::bench {
namespace {

constexpr const char* kHowToRead =
    "Down is faster, left is more accurate; what has no error stands at the left end. The frontier joins "
    "what nothing beats in both. Hover for all numbers; a click leads to the scene of the panel, with its "
    "trace and pictures.";

ChartWords of_pairs() {
  return {
      "Speed against accuracy",
      "Every method at every setting of its knob, on the same bodies and poses: how long the median query "
      "takes, and how far what it calls the contact is from the exact contact.",
      "error of the contact region / diagonal",
      "off the bodies by no more than this: proved",
      {{"How to read it", kHowToRead},
       {"What counts as error",
        "The Hausdorff distance between the exact contact region and that of the answer, over the larger "
        "body's diagonal, averaged over poses; for methods that say only yes or no, the share of wrong "
        "ones. Contact where there is none, or none where there is, counts as one whole diagonal, and so "
        "does what is no answer."},
       {"What is proved",
        "Ours alone proves what it says. Its exact answers are off by nothing; those to a tolerance, or of "
        "a level that a budget allowed, come with a bound (a cross at the same height): where listed faces "
        "meet, the distances from the two bodies add up to no more. That is another length than the error "
        "on the axis: where surfaces graze each other, moving them by a little moves the contact by far "
        "more. Column \"off\" is the length that is proved, measured."}}};
}

/// What counts as error, and what is proved, for one number.
struct NumberWords {
  const char *name, *purpose, *error, *judged, *proved;
};

NumberWords words_of_number(Quantity quantity) {
  if (quantity == Quantity::first_contact)
    return {
        "time of first contact",
        "B moves straight, two diagonals far, past A or into it: how long every method takes to say when "
        "they first meet, and how far off that is.",
        "error of the time of contact / motion",
        "The time at which a method first finds the bodies in contact, beside the true one, in parts of "
        "the motion, averaged over motions. Never, where they meet, or a time, where they never do, counts "
        "as the whole motion, and so does what is no answer. An interval stands for its later end, at "
        "which contact was found.",
        "Ours gives an interval: no contact before it, a contact at its end."};
  if (quantity == Quantity::depth)
    return {
        "penetration depth",
        "Two bodies that overlap: how long every method takes to say how far one must move to leave the "
        "other, and how far off that is.",
        "error of the depth / diagonal",
        "How far the depth is outside the interval that is known to hold it, over the larger body's "
        "diagonal, averaged over poses: the error is at least this. An interval stands for its upper end, "
        "the length of a translation that parts the bodies. What is no answer counts as one whole diagonal.",
        "Ours gives an interval: a shorter translation than its lower end parts nothing, and one as long "
        "as its upper end does."};
  return {"distance",
          "Two bodies apart: how long every method takes to say how far, and how far off that is.",
          "error of the distance / diagonal",
          "The distance that a method says, beside the true one, over the larger body's diagonal, averaged "
          "over poses. An interval stands for its upper end, that of two points which were found. What is no "
          "answer counts as one whole diagonal.",
          "Ours gives an interval that holds the distance, at every tolerance and within every budget."};
}

ChartWords of_number(Quantity quantity) {
  const NumberWords n = words_of_number(quantity);
  return {
      std::string("Speed against accuracy: ") + n.name,
      n.purpose,
      n.error,
      "the interval is no wider than this: proved",
      {{"How to read it", kHowToRead},
       {"What counts as error",
        std::string(n.judged) +
            " The truth is our own proved interval at its finest setting, which the command stability "
            "--quantity holds against rational arithmetic on small bodies."},
       {"What is proved",
        std::string(n.proved) +
            " How wide it is, in the unit of the error, is a cross at the same height: the error is never "
            "more. Other methods prove nothing."}}};
}

}  // namespace

ChartWords chart_words(Quantity quantity) {
  return quantity == Quantity::pairs ? of_pairs() : of_number(quantity);
}

}  // namespace lrb::bench
