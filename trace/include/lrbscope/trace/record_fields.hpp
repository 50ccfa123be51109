#pragma once
/// Field tables of the records in traces, scenarios and golden runs. first_divergence(), reading and writing
/// of trace and summary JSON, the keys of a scenario's query and the options of the same names are derived
/// from them. A test compares them with the published schemas.

#include <lrbscope/collide.hpp>
#include <lrbscope/core/fields.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<CollideRequest> =
    std::tuple{field("mode", &CollideRequest::mode),
               field("recursion", &CollideRequest::recursion),
               field("predicates", &CollideRequest::predicates),
               field("wrapper", &CollideRequest::wrapper),
               field("contacts", &CollideRequest::contacts),
               field("interiors_overlap", &CollideRequest::interiors_overlap),
               field("tolerance", &CollideRequest::tolerance, Kept::if_set),
               field("max_tests", &CollideRequest::max_tests, Kept::if_set),
               field("max_time", &CollideRequest::max_time, Kept::if_set),
               field("separation", &CollideRequest::separation, Kept::if_set),
               field("max_pairs", &CollideRequest::max_pairs, Kept::if_set)};

template <>
inline constexpr auto kFields<Counters> =
    std::tuple{field("face_tests", &Counters::face_tests),
               field("real_tests", &Counters::real_tests),
               field("exact_fallbacks", &Counters::exact_fallbacks),
               field("node_pairs", &Counters::node_pairs),
               field("box_tests", &Counters::box_tests),
               field("prefilter_tests", &Counters::prefilter_tests),
               field("refinements", &Counters::refinements),
               field("regions_opened", &Counters::regions_opened),
               field("face_tests_by_level", &Counters::face_tests_by_level)};

template <>
inline constexpr auto kFields<trace::StepResult> =
    std::tuple{field("relation", &trace::StepResult::relation),
               field("interiors_overlap", &trace::StepResult::interiors_overlap),
               field("pairs", &trace::StepResult::pair_count),
               field("fingerprint", &trace::StepResult::fingerprint, Kept::always, Form::hash),
               field("error_bound", &trace::StepResult::error_bound, Kept::if_coarse, Form::or_infinite),
               field("finished", &trace::StepResult::finished, Kept::if_coarse),
               field("separation", &trace::StepResult::separation, Kept::if_set),
               field("distance", &trace::StepResult::distance, Kept::if_set),
               field("clash", &trace::StepResult::clash, Kept::if_set),
               field("near", &trace::StepResult::near, Kept::if_set),
               field("manifold", &trace::StepResult::manifold, Kept::if_set),
               field("points", &trace::StepResult::points, Kept::if_set),
               field("engine", &trace::StepResult::engine, Kept::if_set),
               field("counters", &trace::StepResult::counters)};

template <>
inline constexpr auto kFields<trace::BodyInfo> =
    std::tuple{field("name", &trace::BodyInfo::name),
               field("source", &trace::BodyInfo::source),
               field("hash", &trace::BodyInfo::hash, Kept::always, Form::hash),
               field("dim", &trace::BodyInfo::dim),
               field("closed", &trace::BodyInfo::closed),
               field("real_faces", &trace::BodyInfo::real_faces, Kept::always, Form::id),
               field("total_faces", &trace::BodyInfo::total_faces, Kept::always, Form::id),
               field("outer_faces", &trace::BodyInfo::outer_faces, Kept::always, Form::id),
               field("regions", &trace::BodyInfo::regions, Kept::always, Form::id),
               field("layers", &trace::BodyInfo::layers, Kept::always, Form::id),
               field("real_simplices", &trace::BodyInfo::real_simplices, Kept::always, Form::id),
               field("simplices", &trace::BodyInfo::simplices, Kept::always, Form::id)};

static_assert(covers_all_fields<CollideRequest>);
static_assert(covers_all_fields<Counters>);
static_assert(covers_all_fields<trace::StepResult>);
static_assert(covers_all_fields<trace::BodyInfo>);

}  // namespace lrb
