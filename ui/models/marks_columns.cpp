// SPDX-License-Identifier: Apache-2.0
#include "ui/models/marks_columns.h"

#define TEXT(text) QT_TRANSLATE_NOOP("boresight::ui::MarksModel", text)

namespace boresight::ui {

const std::array<ColumnInfo, MarksModel::kColumnCount> kMarksColumns = {{
    {TEXT("On"), TEXT("Whether the mark takes part in solving. One that is off is kept."), -1},
    {TEXT("Mark"), TEXT("Its name; landmarks keep theirs over images. Double click renames."), -1},
    {TEXT("u, px"),
     TEXT("Where it was seen, pixels to the right of the centre of the top-left pixel; of a line "
          "its first place."),
     2},
    {TEXT("v, px"),
     TEXT("Where it was seen, pixels below the centre of the top-left pixel; of a line its first "
          "place."),
     2},
    {TEXT("dx, px"),
     TEXT("Seen minus predicted, to the right; of a line the distance of its first end across the "
          "edge."),
     2},
    {TEXT("dy, px"),
     TEXT("Seen minus predicted, downwards; of a line the distance of its second end across the "
          "edge."),
     2},
    {TEXT("Sigmas"),
     TEXT("The residual in units of its own standard deviation; above 3 the mark stands out."), 1},
    {TEXT("Middle without, mm"),
     TEXT("How far the middle of the marked places moves when the pose is solved without this "
          "mark, in millimetres."),
     3},
    {TEXT("Without, mrad"),
     TEXT("How far the pose turns when it is solved without this mark, in milliradians."), 3},
    {TEXT("dx, mm"), TEXT("The same at the mark's distance from the camera, in millimetres."), 3},
    {TEXT("dy, mm"), TEXT("The same at the mark's distance from the camera, in millimetres."), 3},
    {TEXT("X, mm"), TEXT("Its place of the station, station frame; of a line the edge's start."),
     3},
    {TEXT("Y, mm"), TEXT("Its place of the station, station frame; of a line the edge's start."),
     3},
    {TEXT("Z, mm"), TEXT("Its place of the station, station frame; of a line the edge's start."),
     3},
    {TEXT("Sigma, px"),
     TEXT("Standard deviation of the place in the image per axis; of a line, of either end across "
          "the edge."),
     2},
    {TEXT("Lock"), TEXT("A locked mark cannot be moved or removed by accident."), -1},
    {TEXT("Comment"), TEXT("Anything worth knowing of the mark. Double click edits."), -1},
}};

}  // namespace boresight::ui
