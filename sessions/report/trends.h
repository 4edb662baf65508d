// SPDX-License-Identifier: Apache-2.0
// Corrections, residuals and checks of stations over many sessions (sols).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/report/pdf_canvas.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The figures of a trend. Corrections are at the end effector, along and about its axes; at the
/// camera centre where the case has no end effector.
enum class TrendFigure { kX, kY, kZ, kTurnX, kTurnY, kTurnZ, kResidual };
inline constexpr std::size_t kTrendFigures = 7;
inline constexpr std::array<const char*, kTrendFigures> kTrendNames = {
    "correction_x_mm",    "correction_y_mm",    "correction_z_mm", "correction_rx_mrad",
    "correction_ry_mrad", "correction_rz_mrad", "residual_px"};

/// The last converged run of a case.
struct TrendPoint {
  std::filesystem::path session;
  std::string case_id;
  std::string station;
  std::string time;  ///< START_TIME of the image's label, or empty
  std::array<double, kTrendFigures> figures{};
  std::array<double, kTrendFigures> sigmas{};  ///< of the corrections; 0 of the residual
  std::array<bool, kTrendFigures> outlier{};   ///< see flagOutliers
  std::string review;                          ///< review status
  std::optional<int> checks_failed;            ///< of the decision; empty without one

  bool flagged() const;
};

/// Points of every case of a session with a converged run of its current inputs, without flags of
/// outliers. Other cases are named in `remarks`. After a stop, returns the points so far.
/// InputError.
std::vector<TrendPoint> trendOf(const Session& session, const std::filesystem::path& file,
                                std::vector<std::string>& remarks,
                                const std::stop_token& stop = {});

inline constexpr double kOutlierScores = 3.5;
inline constexpr std::size_t kFewestForOutliers = 5;

/// Flags figures whose modified z-score (Iglewicz and Hoaglin 1993: 0.6745 |v - median| / MAD)
/// among the points of their station exceeds 3.5. The deviation counts as at least 0.6745 sigma.
/// Stations with fewer than 5 points have no outliers.
void flagOutliers(std::vector<TrendPoint>& points);

std::string trendTable(std::span<const TrendPoint> points);
std::string trendCsv(std::span<const TrendPoint> points);
/// One page per station: corrections and residuals over the sessions, outliers as crosses.
std::vector<std::uint8_t> trendPdf(std::span<const TrendPoint> points);

}  // namespace boresight::sessions
