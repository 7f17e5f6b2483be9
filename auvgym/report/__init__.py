"""Pages to look at: interactive figures and leaderboards (plotly; extra ``report``).

Every page is one HTML file that holds all it needs and opens without a network.

``episode``   an episode with a time slider;  ``plan``  a planner's answer on its map
``scene``     what both are drawn with, in space (``space``) and on the plane (``plane``)
``meshes``    obstacles as triangles;  ``theme`` colours that read on light and dark pages
``page``      HTML round figures and tables;  ``tables`` rows of results as ranked tables
"""

from auvgym.report.episode import episode_figure
from auvgym.report.page import figure_page, leaderboard_page
from auvgym.report.plan import plan_figure

__all__ = ["episode_figure", "figure_page", "leaderboard_page", "plan_figure"]
