#pragma once
/// Pictures of answers: distance, near pairs, first contact, clash, contact manifolds, distances of points,
/// self-intersections, intersecting faces, separating plane, separation.

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::pictures {

// `look` sets the size and the up direction. All throw EnvironmentError if this machine cannot render.

/// Draws both bodies with the segment between their closest points and its length, and a close-up of the
/// segment if it is short.
render::Image picture_of(const DistanceResult& result, const PosedBodies& bodies, const pictures::Look& look);

/// Draws both bodies with the faces of the pairs in the colour of contacts and segments between closest
/// points, at most those of the 1000 nearest pairs. `within`: the distance that was requested.
render::Image picture_of(const NearPairsResult& result, double within, const PosedBodies& bodies,
                         const pictures::Look& look);

/// Draws both bodies at their first contact, B at earlier times as ghosts, and the path of B's centre.
/// Without a contact it draws the entire motion.
render::Image picture_of(const FirstContactResult& result, const LrbRep& a, const LrbRep& b,
                         const Motion& motion_b, const pictures::Look& look);

/// Draws both solids with their contacts and the separation vector of B, and B translated by it as a ghost.
/// The title is the kind of contact.
render::Image picture_of(const ClashResult& result, const PosedBodies& bodies, const pictures::Look& look);

/// Draws both bodies, translucent, with the points of the manifolds and their normals as arrows from A to B.
/// `margin`: that of the request.
render::Image picture_of(const ManifoldResult& result, double margin, const PosedBodies& bodies,
                         const pictures::Look& look);

/// Draws a body, translucent, with points in the colours of their sides and segments to their closest points.
render::Image picture_of(const ShownPoints& points, const LrbRep& body, const pictures::Look& look);

/// Draws a body, translucent, with its faces that intersect in the colour of contacts, and the segments in
/// which they do.
render::Image picture_of(const SelfIntersections& found, const LrbRep& body, const pictures::Look& look);

/// Draws two faces and the bodies around them: their intersection, or the segment between their closest
/// points and a separating plane perpendicular to it. `wrong`: another engine got the pair wrong; then the
/// picture is low, and both bodies are beside it.
render::Image picture_of(const PairExplanation& pair, const PosedBodies& bodies, bool wrong = false,
                         const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

/// Draws both bodies with the separating plane or boxes, and a close-up along the plane.
render::Image picture_of(const WalkExplanation& walk, const PosedBodies& bodies);

/// Draws two separate bodies below the wrappers that prove it: outermost wrappers in panel (a), refined as
/// far as needed in panel (b).
render::Image picture_of(const Separation& separation, const PosedBodies& bodies);

/// The size of all but the last three pictures, unless `look` sets another.
inline constexpr int kAnswerWidth = 1200, kAnswerHeight = 750;

}  // namespace lrb::pictures
