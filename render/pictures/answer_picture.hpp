#pragma once
/// Pictures of answers: how far apart two bodies are, where and when they first meet, how one leaves the
/// other.

#include <string>

#include <lrbscope/clash.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb::run {

/// How large a picture is, and which way is up in it.
struct AnswerLook {
  int width = 1200, height = 750;  ///< pixels
  Eigen::Vector3d up{0, 0, 1};     ///< of bodies in space
};

/// Draws both bodies with the way between their nearest points and its length; beside it, where it is short,
/// from nearby. Throws EnvironmentError if the file cannot be written.
void draw_distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const DistanceResult& result, const AnswerLook& look, const std::string& path);

/// Draws both bodies at their first contact with ghosts of B on its way there, and the point where they meet;
/// of bodies that do not meet, all of the way.
void draw_first_contact(const LrbRep& a, const LrbRep& b, const Motion& motion_b,
                        const FirstContactResult& result, const AnswerLook& look, const std::string& path);

/// Draws both solids with their contacts, the kind of contact as title, and the way on which B leaves A, with
/// B as a ghost where it is apart; of solids that are apart, them alone.
void draw_clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                const ClashResult& result, const AnswerLook& look, const std::string& path);

}  // namespace lrb::run
