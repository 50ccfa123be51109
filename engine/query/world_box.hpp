#pragma once
/// Boxes of bodies in the world, where users of the installed engine find them.

#include "engine/query/walk/world_box.hpp"
