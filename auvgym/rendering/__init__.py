"""Pictures of an episode, frame by frame (pygame; extra ``render``).

``viewer``    the window or image, and what is drawn when
``subjects``  what a picture needs to know of a world and an episode
``layout``    which panel goes where;  ``axes`` metres to pixels, ticks and labels
``canvas``    lines, shapes and text on a surface;  ``palette`` colours
``shapes``    obstacles cut horizontally and vertically (plain NumPy, shared with the report)
``chart`` ``currents`` ``marks``  the plan view;  ``profile`` ``strips`` ``panel``  beside it
"""

from auvgym.rendering.viewer import Viewer

__all__ = ["Viewer"]
