"""What figures and workbook are both made of: tables and places of a run, outages, variants."""
