"""Mode shapes for other programs: files for ParaView, and a page that moves."""
