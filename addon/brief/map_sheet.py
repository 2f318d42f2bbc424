"""Map sheet: one SVG drawing that fills a sheet of paper.

It has the nine elements that NWCG's map standard names (PMS 936, "STANDL-SGD"): scale, title, author, north
arrow, date and time, legend, source, graticule or grid, datum and projection.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..html_text import data_uri, quote
from . import base_map, graticule, map_panel, sheet_map
from .briefing import Briefing
from .map_frame import MapFrame
from .mercator import Box
from .paper import SIZES, Orientation, Paper
from .sheet_map import Content
from .sheet_margin import Margin
from .sheet_options import SheetOptions, Titles
from .sheet_text import FONT, Column

_PANEL = 58.0  # width of the panel at the side in landscape, mm at A4
_GAP = 3.5  # mm
_TIGHTER = 0.94


@dataclass(frozen=True)
class MapSheet:
    """A map sheet.

    Attributes
    ----------
    svg
        Drawing of the area within the margins of the paper, in mm.
    frame
        Frame of the map in this area.
    """

    paper: Paper
    frame: MapFrame
    svg: str


def draw(briefing: Briefing, options: SheetOptions, titles: Titles) -> MapSheet:
    """Draw the sheet."""
    paper = Paper.named(options.paper, options.orientation or orientation(briefing, options.paper))
    frame, content, columns = _layout(briefing, options, titles, paper)
    width, height = paper.area
    size = 2.1 * paper.text_scale
    picture = data_uri("image/jpeg", base_map.picture(briefing.run, briefing.elevation, frame))
    box = f'x="{frame.left:.2f}" y="{frame.top:.2f}" width="{frame.width:.2f}" height="{frame.height:.2f}"'
    grid = list(graticule.svg(frame, options.grid, size))
    clipped = [
        f'<image {box} preserveAspectRatio="none" href="{picture}"/>',
        *content.lines,
        *(part for part in grid if part.startswith("<polyline")),
        *content.points,
        *content.labels,
        *_marks(briefing.marks, frame),
    ]
    labels = [part for part in grid if part.startswith("<text")]
    description = f"Map sheet of {titles.incident}, scale 1:{frame.ratio:,.0f}, {titles.period}"
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" role="img" '
        f"aria-label=\"{quote(description)}\" font-family='{FONT}'>"
        f'<rect width="{width:g}" height="{height:g}" fill="#fff"/>'
        f'<clipPath id="map-frame"><rect {box}/></clipPath>'
        f'<g clip-path="url(#map-frame)">{"".join(clipped)}</g>'
        f'<rect {box} fill="none" stroke="#000" stroke-width="0.4"/>{"".join(labels)}'
        f"{''.join(column.svg(x, y) for column, x, y in columns)}</svg>"
    )
    return MapSheet(paper, frame, svg)


def orientation(briefing: Briefing, size: str) -> Orientation:
    """Choose the orientation in which the fire is larger."""
    box = _extent(briefing)
    across, along = box.metres
    short, long = SIZES[size]
    panel = _PANEL * Paper(short, long).text_scale
    landscape = min((long - 20.0 - panel) / across, (short - 26.0) / along)
    portrait = min((short - 20.0) / across, (long - 26.0 - 1.3 * panel) / along)
    return "landscape" if landscape >= portrait else "portrait"


def _extent(briefing: Briefing) -> Box:
    """Choose the extent of the sheet: the burned area with a margin, at least a tenth of the run."""
    return map_panel.around(briefing.fronts, map_panel.bounds(briefing.layers), margin=0.08, parts=10.0)


def _layout(
    briefing: Briefing, options: SheetOptions, titles: Titles, paper: Paper
) -> tuple[MapFrame, Content, list[tuple[Column, float, float]]]:
    """Place the frame and the columns of text; texts become smaller if a panel is too long."""
    width, height = paper.area
    unit = paper.text_scale
    space = graticule.SPACE * unit if options.grid != "none" else 0.3
    box = _extent(briefing)
    while True:
        if paper.width > paper.height:
            panel = _PANEL * unit
            rectangle = (space, space, width - panel - _GAP - 2.0 * space, height - 2.0 * space)
            content = sheet_map.draw(briefing, MapFrame.fitted(box, rectangle), unit)
            column = Margin(briefing, options, titles, content).all(panel, unit)
            columns = [(column, width - panel, 0.0)]
            if column.height <= height:
                return content.frame, content, columns
        else:
            each = (width - 2.0 * _GAP) / 3.0
            low = 0.45 * height
            content = Content(MapFrame.fitted(box, (space, space, width - 2 * space, low)), unit)
            for _ in range(2):  # the legend decides the height of the frame
                frame = MapFrame.fitted(box, (space, space, width - 2.0 * space, low))
                content = sheet_map.draw(briefing, frame, unit)
                three = Margin(briefing, options, titles, content).three(each, unit)
                tall = max(column.height for column in three)
                low = height - tall - 2.0 * space - 1.0
                if low < 0.45 * height:
                    break
            top = content.frame.top + content.frame.height + space + 1.0
            if low >= 0.45 * height:
                placed = [(column, k * (each + _GAP), top) for k, column in enumerate(three)]
                return content.frame, content, placed
        unit *= _TIGHTER


def _marks(words: tuple[str, ...], frame: MapFrame) -> list[str]:
    """Write large words across the map, so that a picture of a part of it does not pass for a forecast."""
    marks = []
    for number, word in enumerate(words):
        size = min(0.9 * frame.width / (0.72 * len(word)), 0.3 * frame.height)
        x = frame.left + 0.5 * frame.width
        y = frame.top + frame.height * (number + 1.0) / (len(words) + 1.0)
        marks.append(
            f'<text class="mark" x="{x:.2f}" y="{y:.2f}" font-size="{size:.2f}" font-weight="800" '
            f'text-anchor="middle" dominant-baseline="central" transform="rotate(-14 {x:.2f} {y:.2f})" '
            f'fill="#b00020" fill-opacity="0.17" stroke="#fff" stroke-opacity="0.35" '
            f'stroke-width="{0.012 * size:.2f}">{quote(word)}</text>'
        )
    return marks
