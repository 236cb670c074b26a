"""The trial of printed mathematics, for any paper: `Paper`, and `judge` for one expression without a paper."""

from lagrotor.paper.ledger import judge as judge
from lagrotor.paper.papers import Paper as Paper
