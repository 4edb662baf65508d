#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the window's fonts from Inter (package fonts-inter): make_fonts.py FOLDER

Qt 5 cannot choose the features of a font, so the figures of equal width (tnum) become the figures.
The characters are those of Latin, Greek and Cyrillic texts and the signs of the window. The family
has a name of its own, so that an installed Inter is not used in its place; its bold is Inter's
semi-bold.
"""
import sys

from fontTools import subset
from fontTools.ttLib import TTFont

FAMILY = "Inter Tabular"
RANGES = [(0x20, 0x24F), (0x300, 0x45F), (0x2000, 0x206F), (0x2070, 0x209F), (0x20AC, 0x20AC),
          (0x2100, 0x21FF), (0x2200, 0x23FF), (0x2460, 0x27BF)]


def tabular(font):
    """By name of a glyph the one that tnum puts in its place."""
    glyphs = {}
    table = font["GSUB"].table
    for record in table.FeatureList.FeatureRecord:
        if record.FeatureTag == "tnum":
            for index in record.Feature.LookupListIndex:
                for part in table.LookupList.Lookup[index].SubTable:
                    glyphs.update(getattr(part, "ExtSubTable", part).mapping)
    return glyphs


def make(source, target, style, weight):
    font = TTFont(source)
    glyphs = tabular(font)
    for part in font["cmap"].tables:
        if part.isUnicode():
            for code in range(ord("0"), ord("9") + 1):  # tables may share a map
                part.cmap[code] = glyphs.get(part.cmap[code], part.cmap[code])
    options = subset.Options(layout_features=["kern", "ccmp", "mark", "mkmk", "locl"],
                             name_IDs=[0, 1, 2, 3, 4, 5, 6, 7, 13, 14], notdef_outline=True)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=[code for first, last in RANGES for code in range(first, last + 1)])
    subsetter.subset(font)
    full = FAMILY if style == "Regular" else f"{FAMILY} {style}"
    for identity, text in {1: FAMILY, 2: style, 3: full, 4: full,
                           6: f"InterTabular-{style}"}.items():
        font["name"].setName(text, identity, 3, 1, 0x409)
    font["OS/2"].usWeightClass = weight
    bold = style == "Bold"
    font["OS/2"].fsSelection = (font["OS/2"].fsSelection & ~0x61) | (0x20 if bold else 0x40)
    font["head"].macStyle = 1 if bold else 0
    font["CFF "].cff.topDictIndex[0].FamilyName = FAMILY
    font["CFF "].cff.topDictIndex[0].FullName = full
    font.save(target)


make(sys.argv[1] + "/Inter-Regular.otf", "InterTabular-Regular.otf", "Regular", 400)
make(sys.argv[1] + "/Inter-SemiBold.otf", "InterTabular-Bold.otf", "Bold", 700)
