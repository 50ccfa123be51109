#include "engine/lrb/wrapper.hpp"

#include <algorithm>

namespace lrb {

Wrapper::Wrapper(const LrbRep& rep, WrapperMode mode)
    : rep_(&rep),
      mode_(mode),
      region_stamp_(rep.region_count(), 0),
      discarded_stamp_(mode == WrapperMode::unregularised ? rep.face_count() : 0, 0) {}

void Wrapper::reset() {
  // Raising the epoch makes all stamps outdated at once: O(1) in the number of regions and faces.
  order_.clear();
  excluded_count_ = 0;
  if (++epoch_ == 0) {  // after 2^32 resets the stamps of the first epoch would look current
    std::fill(region_stamp_.begin(), region_stamp_.end(), 0);
    std::fill(discarded_stamp_.begin(), discarded_stamp_.end(), 0);
    epoch_ = 1;
  }
}

void Wrapper::discard_lids(RegionId r) {
  for (const FaceId lid : rep_->lids(r)) discarded_stamp_[lid] = epoch_;
}

bool Wrapper::refine_face(FaceId f) {
  if (rep_->is_real(f) || !on_boundary(f)) return false;
  // A pseudo face on the boundary hides the region behind it.
  const RegionId r = rep_->inner_cell(f).as_region();
  if (mode_ == WrapperMode::regularised) return refine(r);
  // Unregularised: the first refined lid excludes the region and so exposes its floor. Each further lid only
  // disappears.
  if (included(r)) {
    order_.push_back(r);
    region_stamp_[r] = epoch_;
    ++excluded_count_;
  }
  discarded_stamp_[f] = epoch_;
  return true;
}

bool Wrapper::coarsen(RegionId r) {
  if (included(r)) return false;
  // Epochs start at 1, so stamp 0 means "included" at any time.
  region_stamp_[r] = 0;
  --excluded_count_;
  if (mode_ == WrapperMode::unregularised)
    for (const FaceId lid : rep_->lids(r)) discarded_stamp_[lid] = 0;
  // The region refined last is usually the first to be taken back.
  const auto last = std::find(order_.rbegin(), order_.rend(), r);
  order_.erase(std::next(last).base());
  return true;
}

void Wrapper::refine_all() {
  for (RegionId r = 0; r < rep_->region_count(); ++r) refine(r);
}

bool Wrapper::on_boundary(FaceId f) const {
  // Boundary of a union of cells: exactly one side of the face is included.
  if (mode_ == WrapperMode::regularised)
    return included(rep_->inner_cell(f)) != included(rep_->outer_cell(f));
  // A face is on the boundary once the cell in front of it is not included, unless it is a lid that was
  // discarded itself.
  return !included(rep_->outer_cell(f)) && (rep_->is_real(f) || discarded_stamp_[f] != epoch_);
}

std::vector<FaceId> Wrapper::boundary() const {
  // A boundary face borders on the outside or on an excluded region, so these lists contain all of them.
  std::vector<FaceId> faces;
  const auto add = [&](std::span<const FaceId> some) {
    for (const FaceId f : some)
      if (on_boundary(f)) faces.push_back(f);
  };
  add(rep_->outermost_faces());
  for (const RegionId r : order_) add(rep_->collector(r));
  // A face between two excluded regions is in both collectors, and an outermost face may be a lid of one.
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

}  // namespace lrb
