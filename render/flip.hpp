#pragma once
/// The perceived difference of two pictures: FLIP (Andersson et al., "FLIP: A Difference Evaluator for
/// Alternating Images", HPG 2020), for images of 8 bits per channel.

#include <lrbscope/render/image.hpp>

namespace lrb::render {

/// Returns the mean over all pixels of the error that a viewer perceives when two pictures of the same size
/// alternate, in [0, 1]; 67 pixels per degree, as in the paper (0.7 m from a 0.7 m wide monitor of 3840
/// pixels). Alpha is ignored.
double mean_flip(const Image& expected, const Image& actual);

}  // namespace lrb::render
