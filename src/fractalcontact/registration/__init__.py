"""Two faces of one joint in one frame: the motion that makes their gap most even, and its error."""
