// SPDX-License-Identifier: Apache-2.0
#pragma once

// A pose from 2D-3D correspondences, in the order of use.
#include "core/pnp/correspondence.h"
#include "core/pnp/p3p.h"
#include "core/pnp/pnp_options.h"
#include "core/pnp/pnp_ransac.h"
#include "core/pnp/refine_pose.h"
